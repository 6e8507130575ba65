//! Which processor cores the sides of a measurement run on.
//!
//! Where the operating system puts two processes that wait for each other decides more than any library between them:
//! on one core a message costs a change of process, on two it may have to wake the other core. A ratio of ways that were
//! put in different places says nothing, so both can be told where to be.

use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use std::sync::OnceLock;

/// Where the processes of a measurement run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cores {
    /// Wherever the operating system puts them, and moves them to.
    #[default]
    Any,
    /// All on one core.
    One,
    /// This process on one core, the others on another.
    Two,
}

/// The core of the other processes, where they have another than this one.
static OTHERS: OnceLock<usize> = OnceLock::new();

impl Cores {
    /// Puts this process there, and those that it starts from now on.
    ///
    /// # Errors
    /// There are not as many cores for this process, or the operating system refuses.
    pub fn occupy(self) -> scl::Result<()> {
        let allowed = sched_getaffinity(None)?;
        let mut cores = (0..CpuSet::MAX_CPU).filter(|&core| allowed.is_set(core));
        let few = || scl::Error::message("this process has one core only: leave `--cores two` away");
        if self == Self::Any {
            return Ok(());
        }
        let own = cores.next().ok_or_else(few)?;
        if self == Self::Two {
            let _already_set = OTHERS.set(cores.next().ok_or_else(few)?);
        }
        Ok(sched_setaffinity(None, &only(own))?)
    }

    pub(crate) fn in_words(self) -> Option<&'static str> {
        match self {
            Self::Any => None,
            Self::One => Some("all processes ran on one core"),
            Self::Two => Some("the measuring process ran on one core, the others on another"),
        }
    }
}

/// Starts something where the other processes are to be: a process inherits the place of the thread that starts it.
pub(crate) fn with_others<R>(start: impl FnOnce() -> R) -> scl::Result<R> {
    let Some(&core) = OTHERS.get() else { return Ok(start()) };
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
    fn of_a_child() -> String {
        let status = Command::new("grep").args(["Cpus_allowed_list", "/proc/self/status"]).output().unwrap();
        String::from_utf8(status.stdout).unwrap()
    }

    #[test]
    fn one_core_is_everybodys_and_two_are_one_each() {
        // Threads of their own, because the place of a thread is not taken back.
        let on_one = spawn(|| Cores::One.occupy().map(|()| [of_a_child(), with_others(of_a_child).unwrap()]));
        let [own, others] = on_one.join().unwrap().unwrap();
        assert_eq!(own, others);
        let on_two = spawn(|| Cores::Two.occupy().map(|()| [of_a_child(), with_others(of_a_child).unwrap()]));
        match on_two.join().unwrap() {
            Ok([own, others]) => assert_ne!(own, others),
            Err(error) => assert!(error.to_string().contains("one core only"), "{error}"),
        }
    }
}
