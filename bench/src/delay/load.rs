//! Load on the machine: one thread per core that computes, and one that writes a file.

use std::fs::File;
use std::hint::black_box;
use std::io::{Seek, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

/// Bytes that are written to the file before it is overwritten from its start.
const FILE_SIZE: usize = 1 << 20;

/// The running threads; dropping it ends them.
pub(super) struct Load {
    is_ended: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl Load {
    pub(super) fn start() -> scl::Result<Self> {
        let file = tempfile::tempfile()?;
        let mut load = Self { is_ended: Arc::default(), threads: Vec::new() };
        for _ in 0..thread::available_parallelism()?.get() {
            let is_ended = Arc::clone(&load.is_ended);
            load.threads.push(thread::Builder::new().spawn(move || compute(&is_ended))?);
        }
        let is_ended = Arc::clone(&load.is_ended);
        load.threads.push(thread::Builder::new().spawn(move || write(&is_ended, file))?);
        Ok(load)
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.is_ended.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            // A thread that panicked has ended as well.
            let _ended = thread.join();
        }
    }
}

fn compute(is_ended: &AtomicBool) {
    let mut value = 1_u64;
    while !is_ended.load(Ordering::Relaxed) {
        value = black_box(value.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
    }
}

fn write(is_ended: &AtomicBool, mut file: File) {
    let block = vec![7; FILE_SIZE];
    while !is_ended.load(Ordering::Relaxed) {
        let written = file.rewind().and_then(|()| file.write_all(&block)).and_then(|()| file.sync_data());
        // A full disk only removes the load on the disk; the other threads go on.
        if written.is_err() {
            return;
        }
    }
}
