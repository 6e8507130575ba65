//! Work that keeps the machine busy: a thread a core that computes, and one that writes a file.

use std::fs::File;
use std::hint::black_box;
use std::io::{Seek, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

/// What is written to the file before it starts again from its beginning, in bytes.
const WRITTEN: usize = 1 << 20;

/// The work; it ends when dropped.
pub(super) struct Load {
    ended: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl Load {
    pub(super) fn start() -> scl::Result<Self> {
        let file = tempfile::tempfile()?;
        let mut load = Self { ended: Arc::default(), threads: Vec::new() };
        for _ in 0..thread::available_parallelism()?.get() {
            let ended = Arc::clone(&load.ended);
            load.threads.push(thread::Builder::new().spawn(move || compute(&ended))?);
        }
        let ended = Arc::clone(&load.ended);
        load.threads.push(thread::Builder::new().spawn(move || write(&ended, file))?);
        Ok(load)
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            // A thread that panicked does not work any more either.
            let _ended = thread.join();
        }
    }
}

fn compute(ended: &AtomicBool) {
    let mut value = 1_u64;
    while !ended.load(Ordering::Relaxed) {
        value = black_box(value.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
    }
}

fn write(ended: &AtomicBool, mut file: File) {
    let block = vec![7; WRITTEN];
    while !ended.load(Ordering::Relaxed) {
        // A full disk takes the load away from the disk only; the computing goes on.
        let written = file.rewind().and_then(|()| file.write_all(&block)).and_then(|()| file.sync_data());
        if written.is_err() {
            return;
        }
    }
}
