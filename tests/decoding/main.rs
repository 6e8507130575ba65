//! How much memory decoding takes, counted by an allocator. A program of its own, whose tests take turns, because
//! nothing else may allocate meanwhile.

mod estimate;
mod gates;
mod serde_types;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::sync::{Mutex, MutexGuard, PoisonError};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

scl::topology!("topologies/decoding.yaml");

const MIB: usize = 1 << 20;

/// Held by each test.
fn turn() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What a call returns, and how many bytes it allocated. A list that grows counts with its final capacity.
fn counted<R>(call: impl FnOnce() -> R) -> (R, u64) {
    let region = Region::new(ALLOCATOR);
    let result = call();
    let bytes = region.change().bytes_allocated as u64;
    (result, bytes)
}
