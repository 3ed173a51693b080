//! Work on ranges of a long list, on several threads of the caller's choice.

use std::ops::Range;

/// More threads than this are not started.
const MOST: usize = 64;

/// Does `work` on consecutive ranges that together are `0..count` and gives its results in their order; 0 threads means as
/// many as the machine has. Ranges have at least `least` elements.
pub(crate) fn in_ranges<T: Send>(
    count: usize,
    threads: usize,
    least: usize,
    work: impl Fn(Range<usize>) -> T + Sync,
) -> Vec<T> {
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = if threads == 0 { available() } else { threads };
    let size = count.div_ceil(threads.clamp(1, MOST)).max(least).max(1);
    if size >= count {
        return vec![work(0..count)];
    }
    let work = &work;
    std::thread::scope(|scope| {
        let ranges = (0..count).step_by(size).map(|start| start..count.min(start + size));
        let workers: Vec<_> = ranges
            .map(|range| {
                let own = range.clone();
                (std::thread::Builder::new().spawn_scoped(scope, move || work(own)), range)
            })
            .collect();
        let results = workers.into_iter().map(|(worker, range)| match worker {
            // A panic in a worker goes on in the caller's thread.
            Ok(worker) => worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // There was no room for one more thread.
            Err(_) => work(range),
        });
        results.collect()
    })
}
