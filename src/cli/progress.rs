//! Progress of long work on a terminal.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
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
    let done = std::sync::atomic::AtomicBool::new(false);
    let result = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(std::sync::atomic::Ordering::Relaxed) {
                bar.set_position((job.progress() * STEPS as f64) as u64);
                bar.set_message(job.stage());
                std::thread::sleep(INTERVAL);
            }
        });
        let result = work(&job);
        done.store(true, std::sync::atomic::Ordering::Relaxed);
        result
    });
    bar.finish_and_clear();
    result
}
