//! Progress and cancellation of long work.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Watches and cancels a long call, from any thread. Cancelling is sticky.
#[derive(Debug, Default)]
pub struct Job {
    cancelled: AtomicBool,
    /// Bits of an `f64` in [0, 1].
    progress: AtomicU64,
    stage: Mutex<&'static str>,
}

/// The caller cancelled the work; what it was changing is as it was before.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Job {
    /// A job that has not begun.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the work to stop at its next step.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// True once [`cancel`](Self::cancel) was called.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// How much is done, in [0, 1].
    pub fn progress(&self) -> f64 {
        f64::from_bits(self.progress.load(Ordering::Relaxed))
    }

    /// Name of the present stage.
    pub fn stage(&self) -> &'static str {
        self.stage.lock().map_or("", |stage| *stage)
    }

    /// Called by the work itself: reports `progress` in [0, 1] and learns whether to go on.
    ///
    /// # Errors
    /// [`Cancelled`] when the caller asked for it.
    pub fn step(&self, stage: &'static str, progress: f64) -> Result<(), Cancelled> {
        self.progress.store(progress.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
        if let Ok(mut current) = self.stage.lock() {
            *current = stage;
        }
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }
}
