//! Faults on demand. No part of `include/welt.h`: a test declares the function itself, see `tests/cpp/faults.cpp`.

use crate::fault::{self, Fault};

/// Arms a fault on this thread for its n-th place from now, 1-based. kind: 1 panics, 2 cancels the job, 0 disarms. Gives 1
/// where the one that was armed before has not struck, else 0.
#[unsafe(no_mangle)]
pub extern "C" fn welt_fault_arm(kind: u32, n: u64) -> i32 {
    let fault = match kind {
        1 => Some(Fault::Panic),
        2 => Some(Fault::Cancel),
        _ => None,
    };
    i32::from(fault::arm(fault, n))
}
