//! Progress and cancellation of long work.

use crate::fault;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Is told the progress of a job, in [0, 1].
struct Observer(Box<dyn Fn(f64) + Send + Sync>);

impl std::fmt::Debug for Observer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Observer")
    }
}

/// Watches and cancels a long call, from any thread. Cancelling is sticky.
#[derive(Default, Debug)]
pub struct Job {
    cancelled: AtomicBool,
    /// Bits of an `f64` in [0, 1].
    progress: AtomicU64,
    stage: Mutex<&'static str>,
    observer: Option<Observer>,
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

    /// Calls `observer` with the progress at every step, on the thread that does the work. It may cancel the job.
    pub fn observe(&mut self, observer: impl Fn(f64) + Send + Sync + 'static) {
        self.observer = Some(Observer(Box::new(observer)));
    }

    /// Asks the work to stop at its next step.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// True once [`cancel`](Self::cancel) was called.
    pub fn is_cancelled(&self) -> bool {
        fault::poll(self, self.stage());
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
        if let Some(Observer(observer)) = &self.observer {
            observer(self.progress());
        }
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }
}
