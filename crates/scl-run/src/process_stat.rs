//! What `/proc/<pid>/stat` tells about a process, as in `proc_pid_stat(5)`.

use rustix::process::Pid;
use std::collections::HashMap;
use std::fs;

/// A process.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ProcessStat {
    /// `None` if the parent is outside of this container, or the process is being reaped; the same applies to `group`.
    pub(crate) parent: Option<Pid>,
    pub(crate) group: Option<Pid>,
    /// When it was started, in clock ticks since boot. Together with the process id, this identifies it even if the id
    /// is reused.
    pub(crate) started: u64,
    /// Whether it waits to be reaped.
    has_ended: bool,
    /// Whether a signal has stopped it.
    pub(crate) is_stopped: bool,
    /// Whether a debugger has stopped it.
    pub(crate) is_traced: bool,
    /// The address at which its stack begins. It changes with `exec`.
    pub(crate) stack: String,
}

impl ProcessStat {
    /// Reads the state of a process; `None` if it has ended, even if it is not reaped yet.
    pub(crate) fn of(process: Pid) -> Option<Self> {
        Self::read(process).filter(|stat| !stat.has_ended)
    }

    fn read(process: Pid) -> Option<Self> {
        Self::parse(&fs::read_to_string(format!("/proc/{process}/stat")).ok()?)
    }

    fn parse(stat: &str) -> Option<Self> {
        // The name of the program, in parentheses, may contain anything.
        let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_ascii_whitespace().collect();
        let [state, parent, group, ..] = fields[..] else { return None };
        let threads: usize = fields.get(17)?.parse().ok()?;
        // A process whose main thread has ended is shown as a zombie while its other threads are still running.
        let has_ended = matches!(state, "Z" | "X" | "x") && threads <= 1;
        // 0 if it is outside of this container, -1 while the process is being reaped.
        let id = |field: &str| field.parse().ok().filter(|id| *id > 0).and_then(Pid::from_raw);
        let (parent, group) = (id(parent), id(group));
        let (started, stack) = (fields.get(19)?.parse().ok()?, (*fields.get(25)?).to_owned());
        Some(Self { parent, group, started, has_ended, is_stopped: state == "T", is_traced: state == "t", stack })
    }
}

/// All processes that have not ended.
pub(crate) fn running_processes() -> HashMap<Pid, ProcessStat> {
    all_processes().filter_map(|process| Some((process, ProcessStat::of(process)?))).collect()
}

/// The children of a process, also those that wait to be reaped.
pub(crate) fn children(parent: Pid) -> Vec<Pid> {
    let is_child = |process: &Pid| ProcessStat::read(*process).is_some_and(|stat| stat.parent == Some(parent));
    all_processes().filter(is_child).collect()
}

/// The numbers of all processes.
pub(crate) fn all_processes() -> impl Iterator<Item = Pid> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok().and_then(Pid::from_raw))
}

#[cfg(test)]
impl ProcessStat {
    /// A running process of which only the parent matters.
    pub(crate) fn with_parent(parent: Option<Pid>) -> Self {
        let group = None;
        Self { parent, group, started: 0, has_ended: false, is_stopped: false, is_traced: false, stack: String::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_state_and_the_threads_decide_whether_a_process_lives() {
        let stat = |state, threads| {
            format!("7 (a) b) c) {state} 7 42 3 0 -1 4 5 6 7 8 9 10 11 12 20 0 {threads} 0 99 5 6 7 8 9 1234 0")
        };
        let (parent, group) = (Pid::from_raw(7), Pid::from_raw(42));
        // Ended, stopped by a signal.
        let cases = [
            ("S", 1, false, false),
            ("T", 1, false, true),
            ("t", 1, false, false),
            ("Z", 1, true, false),
            ("X", 1, true, false),
            ("Z", 3, false, false),
        ];
        for (state, threads, has_ended, is_stopped) in cases {
            let stack = "1234".to_owned();
            let expected =
                ProcessStat { parent, group, started: 99, has_ended, is_stopped, is_traced: state == "t", stack };
            assert_eq!(ProcessStat::parse(&stat(state, threads)), Some(expected), "{state}, {threads}");
        }
        let being_reaped = ProcessStat::parse(&stat("X", 0).replace(" 7 42 ", " 0 -1 ")).unwrap();
        assert_eq!((being_reaped.parent, being_reaped.group), (None, None));
        assert_eq!(ProcessStat::parse(""), None);
    }
}
