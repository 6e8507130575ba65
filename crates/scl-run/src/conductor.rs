//! Runs in simulated time: who gives the programs their turns, and lets time pass between them.

use scl_terminal::Problem;
use std::ffi::OsString;
use std::io;
use std::os::fd::{AsRawFd, OwnedFd};
use std::path::PathBuf;
use std::time::Duration;

/// Gives the programs of a run their turns. The time of the run, with all limits and delays of launch files, is the
/// conductor's.
pub trait Conductor: std::fmt::Debug {
    /// Returns what a program that is about to be started needs to take part. `process` is its number in this run,
    /// which it keeps until it has ended; `component` is `None` for the program that records.
    ///
    /// # Errors
    ///
    /// If the operating system refuses what that takes.
    fn seat(&mut self, process: usize, component: Option<&str>) -> io::Result<Seat>;

    /// Returns the time since the start of the run.
    fn now(&self) -> Duration;

    /// Gives turns, and lets time pass until an instant at the latest. `has_arrived` says that something has happened
    /// outside the simulation.
    ///
    /// # Errors
    ///
    /// If the simulation cannot go on.
    fn run(&mut self, until: Option<Duration>, has_arrived: &mut dyn FnMut() -> bool) -> Result<Pause, Problem>;

    /// Notes that a program was sent a signal.
    fn signalled(&mut self, process: usize);

    /// Notes that a program was killed.
    fn killed(&mut self, process: usize);
}

/// Why a conductor gives no more turns at the moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pause {
    /// The time is over.
    Time,
    /// This process has ended, or takes no part any longer.
    Ended(usize),
    /// Something has happened outside the simulation.
    Arrived,
}

/// What a program needs to take part in a simulation. Both descriptors are inherited by the process.
#[derive(Debug)]
pub struct Seat {
    /// The library that is loaded before all others.
    pub library: PathBuf,
    /// Where the program hears of its turns.
    pub socket: OwnedFd,
    /// The epoll descriptor with what the program waits for.
    pub watched: OwnedFd,
}

impl Seat {
    /// The option of `scl __start` for it.
    pub(crate) fn arguments(&self) -> [OsString; 2] {
        let mut value = OsString::from(format!("{},{},", self.socket.as_raw_fd(), self.watched.as_raw_fd()));
        value.push(&self.library);
        ["--seat".into(), value]
    }
}
