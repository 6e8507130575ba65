//! The database thread. A lock or a slow disk blocks this thread, but not the gates.

use std::io;
use std::thread::{self, JoinHandle};
use std::time::{SystemTime, UNIX_EPOCH};

use tokio::sync::mpsc::{self, Receiver, Sender};
use tokio::sync::oneshot;

use super::recorder::{Recorder, Refused};
use crate::ospecorr::occupancy::Channel;
use crate::ospecorr::{Query, Statistics};

/// Maximum number of jobs that wait: those of about two seconds. Further messages wait in the gates, which count what
/// they drop.
const QUEUE: usize = 100;

/// What the thread is to do.
pub enum Job {
    /// Add a block.
    Add(Vec<Channel>),
    /// Write the blocks that were added.
    Flush,
    /// Answer a query.
    Answer(scl::Request<Query, Statistics>),
}

/// The thread. It ends when this is dropped, after it has written what is left.
pub struct Keeper {
    /// Sends jobs to the thread.
    pub jobs: Sender<Job>,
    /// Why the thread has refused the database, if it has.
    pub refused: oneshot::Receiver<Refused>,
    // Declared after `jobs`: fields are dropped in order, and the thread ends only once `jobs` is dropped.
    _thread: JoinOnDrop,
}

struct JoinOnDrop(Option<JoinHandle<()>>);

impl Keeper {
    /// Starts the thread.
    ///
    /// # Errors
    /// The operating system allows no more threads.
    pub fn start(recorder: Recorder) -> io::Result<Self> {
        let (jobs, waiting) = mpsc::channel(QUEUE);
        let (refuse, refused) = oneshot::channel();
        let thread = thread::Builder::new().name("database".to_owned()).spawn(move || {
            if let Err(error) = work(recorder, waiting) {
                // If the receiver is gone, the program is ending anyway.
                let _ = refuse.send(error);
            }
        })?;
        Ok(Self { jobs, refused, _thread: JoinOnDrop(Some(thread)) })
    }
}

impl Drop for JoinOnDrop {
    fn drop(&mut self) {
        // Ignore the result: if the thread panicked, the panic has already been printed.
        let _ = self.0.take().map(JoinHandle::join);
    }
}

fn work(mut recorder: Recorder, mut jobs: Receiver<Job>) -> Result<(), Refused> {
    recorder.flush(now_us())?;
    while let Some(job) = jobs.blocking_recv() {
        match job {
            Job::Add(channels) => recorder.add(now_us(), channels),
            Job::Flush => recorder.flush(now_us())?,
            Job::Answer(request) => {
                let statistics = recorder.answer(request.message().seconds, now_us());
                // A link optimizer that was stopped or has given up no longer waits for the reply.
                let _gone = request.reply(&statistics);
            }
        }
    }
    recorder.flush(now_us())
}

/// Microseconds since 1970. Observations have the time of their arrival, because the database outlives the clock of the
/// spectrum, which begins at 0 again when it restarts.
fn now_us() -> i64 {
    let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(time.as_micros()).unwrap_or(i64::MAX)
}
