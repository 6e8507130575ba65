//! Load on the machine: one thread per core that computes, and one that writes a file.

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
        let mut load = Self { is_ended: Arc::default(), threads: Vec::new() };
        for _ in 0..thread::available_parallelism()?.get() {
            let mut value = 1_u64;
            load.repeat(move || {
                value = black_box(value.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
                true
            })?;
        }
        let (mut file, block) = (tempfile::tempfile()?, vec![7; FILE_SIZE]);
        // If the disk is full, only this thread ends; the others keep the processor busy.
        load.repeat(move || {
            file.rewind().and_then(|()| file.write_all(&block)).and_then(|()| file.sync_data()).is_ok()
        })?;
        Ok(load)
    }

    /// Repeats the work on a separate thread until the load is dropped or the work returns false.
    fn repeat(&mut self, mut work: impl FnMut() -> bool + Send + 'static) -> scl::Result<()> {
        let is_ended = Arc::clone(&self.is_ended);
        let repeated = move || while !is_ended.load(Ordering::Relaxed) && work() {};
        self.threads.push(thread::Builder::new().spawn(repeated)?);
        Ok(())
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.is_ended.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            // Ignore the result: a thread that panicked has ended too.
            let _ended = thread.join();
        }
    }
}
