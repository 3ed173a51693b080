//! Progress of long work on a terminal.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;
use welt::job::Job;

/// Steps of the bar.
const STEPS: u64 = 1000;
/// How often the bar looks at the job.
const INTERVAL: Duration = Duration::from_millis(50);

/// Runs `work` and shows its progress on standard error when that is a terminal.
pub fn watch<T>(work: impl FnOnce(&Job) -> T) -> T {
    let job = Job::new();
    if !std::io::stderr().is_terminal() {
        return work(&job);
    }
    let bar = ProgressBar::new(STEPS);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}") {
        bar.set_style(style);
    }
    // The bar ends with the sender: also when the work panics.
    let (working, ended) = std::sync::mpsc::channel::<()>();
    let (bar, watched) = (&bar, &job);
    let show = move || {
        while ended.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout) {
            bar.set_position((watched.progress() * STEPS as f64) as u64);
            bar.set_message(watched.stage());
        }
    };
    let result = std::thread::scope(|scope| {
        let _working = working;
        // Without room for a thread the work goes on without a bar.
        let _ = std::thread::Builder::new().spawn_scoped(scope, show);
        work(watched)
    });
    bar.finish_and_clear();
    result
}
