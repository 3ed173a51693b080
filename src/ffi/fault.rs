//! Faults on demand. No part of `include/welt.h`: a test declares the function itself, see `tests/cpp/faults.cpp`.

use crate::fault::{self, Fault};

/// Arms a fault on this thread for its n-th place from now, 1-based. kind: 1 panics, 2 cancels the job, 0 disarms.
#[unsafe(no_mangle)]
pub extern "C" fn welt_fault_arm(kind: u32, n: u64) {
    let fault = match kind {
        1 => Some(Fault::Panic),
        2 => Some(Fault::Cancel),
        _ => None,
    };
    fault::arm(fault, n);
}
