//! Pinning the processes of a benchmark to processor cores.
//!
//! For two processes that wait for each other, placement matters more than the library between them: on one core a
//! message costs a context switch, on two cores it may have to wake an idle core. Ratios between variants that ran on
//! different cores are meaningless, so both sides can be pinned.

use clap::ValueEnum;
use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use std::sync::OnceLock;

/// The cores on which the processes of a benchmark run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Cores {
    // The operating system chooses the cores and may move the processes between them.
    #[default]
    Any,
    // All processes share one core.
    One,
    // The measuring process has one core, its workers share another.
    Two,
}

/// The core of the workers, if it is not the core of this process.
static WORKER_CORE: OnceLock<usize> = OnceLock::new();

impl Cores {
    /// Pins the calling thread, the threads it starts from now on, and the worker processes.
    pub(crate) fn pin(self) -> scl::Result<()> {
        if self == Self::Any {
            return Ok(());
        }
        let allowed = sched_getaffinity(None)?;
        let mut cores = (0..CpuSet::MAX_CPU).filter(|&core| allowed.is_set(core));
        let too_few = || scl::Error::message("this process may use one core only: omit `--cores two`");
        let own = cores.next().ok_or_else(too_few)?;
        if self == Self::Two {
            let _already_set = WORKER_CORE.set(cores.next().ok_or_else(too_few)?);
        }
        Ok(sched_setaffinity(None, &only(own))?)
    }

    /// Returns a note on the placement for the report, or `None` if the processes are not pinned.
    pub(crate) fn note(self) -> Option<&'static str> {
        match self {
            Self::Any => None,
            Self::One => Some("all processes ran on one core"),
            Self::Two => Some("the measuring process ran on one core, its workers on another"),
        }
    }
}

/// Calls `start` on the core of the workers, because a process inherits the affinity of the thread that starts it.
pub(crate) fn on_worker_core<R>(start: impl FnOnce() -> R) -> scl::Result<R> {
    let Some(&core) = WORKER_CORE.get() else { return Ok(start()) };
    let own = sched_getaffinity(None)?;
    sched_setaffinity(None, &only(core))?;
    let started = start();
    sched_setaffinity(None, &own)?;
    Ok(started)
}

fn only(core: usize) -> CpuSet {
    let mut cores = CpuSet::new();
    cores.set(core);
    cores
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;
    use std::thread::spawn;

    /// The cores that a process started by this thread may use.
    fn cores_of_a_child() -> String {
        let status = Command::new("grep").args(["Cpus_allowed_list", "/proc/self/status"]).output().unwrap();
        String::from_utf8(status.stdout).unwrap()
    }

    #[test]
    fn one_core_is_shared_and_two_are_separate() {
        // On separate threads, because a thread stays pinned.
        let pinned = |cores: Cores| {
            let children =
                move || cores.pin().map(|()| [cores_of_a_child(), on_worker_core(cores_of_a_child).unwrap()]);
            spawn(children).join().unwrap()
        };
        let [own, worker] = pinned(Cores::One).unwrap();
        assert_eq!(own, worker);
        match pinned(Cores::Two) {
            Ok([own, worker]) => assert_ne!(own, worker),
            Err(error) => assert!(error.to_string().contains("one core only"), "{error}"),
        }
    }
}
