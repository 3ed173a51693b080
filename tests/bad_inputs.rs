//! Bad inputs of every kind, with the functions that are fuzzed: the corpora, what fuzzing found, and both damaged in
//! ways that a fixed seed chooses. None panics, takes long or leaks. The table is written to `target/bad_inputs.md`.

#[path = "fuzz/src/lib.rs"]
mod fuzz;

use std::alloc::{GlobalAlloc, Layout, System};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Counts what is allocated and not freed.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is left to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        LIVE.fetch_add(layout.size(), Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Distinct inputs of each kind.
const INPUTS: usize = 2000;
/// No input may take longer.
const LONGEST: Duration = Duration::from_secs(5);
/// One input in so many is tried again, to see that nothing stays allocated but the tables made at first use.
const AGAIN: usize = 8;
/// Longer inputs are cut, as when fuzzing.
const LENGTH: usize = 8192;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The files of a folder, in the order of their names; none where it does not exist.
fn files(folder: &Path) -> Vec<Vec<u8>> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths.into_iter().map(|path| std::fs::read(path).expect("a file of the corpus")).collect()
}

fn regressions(target: &str) -> Vec<Vec<u8>> {
    files(&root().join("tests/fuzz/regressions").join(target))
}

fn seeds(target: &str) -> Vec<Vec<u8>> {
    let mut seeds = files(&root().join("tests/fuzz/corpus").join(target));
    match target {
        "rules" => seeds.extend(files(&root().join("rules"))),
        "profile" => seeds.extend(files(&root().join("profiles"))),
        _ => {}
    }
    // Several of the slow calls in one input would take long together.
    if target != "abi" {
        seeds.extend(regressions(target));
    }
    seeds
}

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound.max(1) as u64) as usize
    }
}

/// What tends to break readers.
const WORDS: [&[u8]; 24] = [
    b"0",
    b"-1",
    b"1e308",
    b"-1e308",
    b"1e-320",
    b"nan",
    b"inf",
    b"4294967295",
    b"4294967296",
    b"18446744073709551616",
    b"999999999999",
    b"\0",
    b"\xff\xfe",
    b"\n",
    b"\"",
    b"{",
    b"}",
    b"[",
    b"]",
    b"(",
    b")",
    b"#",
    b"/",
    b"  ",
];

/// A copy with one to four changes: bytes, words, parts of another seed, cuts, repetitions.
fn damage(seed: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() + 1);
        let end = (at + random.below(20)).min(bytes.len());
        match random.below(7) {
            0 if at < bytes.len() => bytes[at] = random.below(256) as u8,
            1 => drop(bytes.splice(at..end, WORDS[random.below(WORDS.len())].iter().copied())),
            2 => drop(bytes.drain(at..end)),
            3 => bytes.truncate(at),
            4 => {
                let from = random.below(other.len() + 1);
                let to = (from + random.below(60)).min(other.len());
                drop(bytes.splice(at..at, other[from..to].iter().copied()));
            }
            5 => {
                let part = bytes[at..end].to_vec();
                for _ in 0..random.below(30) {
                    drop(bytes.splice(at..at, part.iter().copied()));
                }
            }
            _ if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            _ => bytes.push(random.below(256) as u8),
        }
    }
    bytes.truncate(LENGTH);
    bytes
}

/// Number of inputs, of those refused, and the longest time.
fn feed(name: &str, target: fuzz::Target) -> (usize, usize, Duration) {
    let seeds = seeds(name);
    assert!(!seeds.is_empty(), "{name} has no corpus");
    let mut inputs: BTreeSet<Vec<u8>> = seeds.iter().cloned().collect();
    inputs.extend(regressions(name));
    let mut random = Random(name.bytes().map(u64::from).sum());
    while inputs.len() < INPUTS {
        let [seed, other] = [0, 0].map(|_| &seeds[random.below(seeds.len())]);
        inputs.insert(damage(seed, other, &mut random));
    }
    let (mut refused, mut longest) = (0, Duration::ZERO);
    for input in &inputs {
        let start = Instant::now();
        let accepted = std::panic::catch_unwind(|| target(input)).unwrap_or_else(|_| {
            panic!("{name}: the panic above came from {:?}", String::from_utf8_lossy(input))
        });
        refused += usize::from(!accepted);
        let time = start.elapsed();
        assert!(time < LONGEST, "{name}: {time:?} for {:?}", String::from_utf8_lossy(input));
        longest = longest.max(time);
    }
    for input in inputs.iter().step_by(AGAIN) {
        let live = LIVE.load(Relaxed);
        target(input);
        assert_eq!(LIVE.load(Relaxed), live, "{name}: memory lost by {:?}", String::from_utf8_lossy(input));
    }
    (inputs.len(), refused, longest)
}

#[test]
fn every_input_is_accepted_or_refused_in_time() {
    let mut table =
        String::from("| input | tried | accepted | refused | longest, ms |\n|---|---|---|---|---|\n");
    let mut bad = 0;
    for &(name, target) in fuzz::TARGETS {
        let (tried, refused, longest) = feed(name, target);
        bad += refused;
        let accepted = tried - refused;
        let _ = writeln!(table, "| {name} | {tried} | {accepted} | {refused} | {} |", longest.as_millis());
    }
    println!("{table}");
    std::fs::write(root().join("target/bad_inputs.md"), &table).expect("the table is written");
    assert!(bad >= 10_000, "only {bad} inputs were bad");
}
