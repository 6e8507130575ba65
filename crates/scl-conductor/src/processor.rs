//! The processor that all programs of a simulation share.

use rustix::thread::CpuSet;

/// Each turn would otherwise wake another processor, which takes twice as long.
pub(crate) fn use_one_processor(number: usize) {
    let Ok(allowed) = rustix::thread::sched_getaffinity(None) else { return };
    let allowed: Vec<usize> = (0..CpuSet::MAX_CPU).rev().filter(|cpu| allowed.is_set(*cpu)).collect();
    let Some(chosen) = allowed.get(number % allowed.len().max(1)) else { return };
    let mut one = CpuSet::new();
    one.set(*chosen);
    // Only the speed depends on it.
    let _slower = rustix::thread::sched_setaffinity(None, &one);
}
