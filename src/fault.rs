//! Panics and cancellations on demand: tests arm one, run a call, and look at what it left behind.
//!
//! Only builds with the feature `fault-injection` have them; in others [`point`] and [`poll`] are empty. What is armed
//! belongs to the thread that armed it.

use crate::job::Job;

/// What strikes.
#[cfg(feature = "fault-injection")]
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fault {
    /// A panic, at any point.
    Panic,
    /// The cancellation of the job, where the work looks at it.
    Cancel,
}

#[cfg(feature = "fault-injection")]
thread_local! {
    /// What is armed, and the number of places that it still passes by.
    static ARMED: std::cell::Cell<Option<(Fault, u64)>> = const { std::cell::Cell::new(None) };
}

/// Arms a fault for the `n`-th place from now, 1-based, in place of what was armed; `None` disarms. Whether the one that
/// was armed before has not struck.
#[cfg(feature = "fault-injection")]
pub fn arm(fault: Option<Fault>, n: u64) -> bool {
    ARMED.replace(fault.map(|fault| (fault, n))).is_some()
}

/// Whether `fault` strikes here.
#[cfg(feature = "fault-injection")]
fn strikes(fault: Fault) -> bool {
    let Some((armed, n)) = ARMED.get().filter(|armed| armed.0 == fault) else { return false };
    ARMED.set((n > 1).then_some((armed, n - 1)));
    n <= 1
}

/// A place of the work where a panic can be armed.
#[inline]
pub fn point(stage: &str) {
    #[cfg(feature = "fault-injection")]
    if strikes(Fault::Panic) {
        // Past the hook, which would print each of thousands.
        std::panic::resume_unwind(Box::new(format!("injected fault in stage {stage}")));
    }
    let _ = stage;
}

/// A place where the work looks at its job: a panic or the cancellation can be armed here.
#[inline]
pub fn poll(job: &Job, stage: &str) {
    #[cfg(feature = "fault-injection")]
    if strikes(Fault::Cancel) {
        job.cancel();
    }
    let _ = job;
    point(stage);
}
