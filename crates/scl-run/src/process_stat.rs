//! What `/proc/<pid>/stat` tells about a process, as in `proc_pid_stat(5)`.

use nix::unistd::Pid;
use std::fs;

/// A process that has not ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ProcessStat {
    pub(crate) group: Pid,
    /// Whether a signal has stopped it.
    pub(crate) is_stopped: bool,
    /// Where its stack begins: another value after `exec`.
    pub(crate) stack: String,
}

impl ProcessStat {
    /// `None` if the process has ended, also while nobody has reaped it.
    pub(crate) fn of(process: Pid) -> Option<Self> {
        Self::parse(&fs::read_to_string(format!("/proc/{process}/stat")).ok()?)
    }

    fn parse(stat: &str) -> Option<Self> {
        // The name of the program, in parentheses, may contain anything.
        let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_ascii_whitespace().collect();
        let [state, _parent, group, ..] = fields[..] else { return None };
        let threads: usize = fields.get(17)?.parse().ok()?;
        // A process whose main thread has ended before the others is shown like one that has ended.
        if matches!(state, "Z" | "X" | "x") && threads <= 1 {
            return None;
        }
        let group = Pid::from_raw(group.parse().ok()?);
        Some(Self { group, is_stopped: state == "T", stack: (*fields.get(25)?).to_owned() })
    }
}

/// The numbers of all processes.
pub(crate) fn all_processes() -> impl Iterator<Item = Pid> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok().map(Pid::from_raw))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_state_and_the_threads_decide_whether_a_process_lives() {
        let stat = |state, threads| {
            format!("7 (a) b) c) {state} 1 42 3 0 -1 4 5 6 7 8 9 10 11 12 20 0 {threads} 0 99 5 6 7 8 9 1234 0")
        };
        let living = |is_stopped| Some((42, is_stopped, "1234".to_owned()));
        let cases = [
            ("S", 1, living(false)),
            ("T", 1, living(true)),
            ("t", 1, living(false)),
            ("Z", 1, None),
            ("X", 1, None),
            ("Z", 3, living(false)),
        ];
        for (state, threads, expected) in cases {
            let found = ProcessStat::parse(&stat(state, threads));
            let found = found.map(|stat| (stat.group.as_raw(), stat.is_stopped, stat.stack));
            assert_eq!(found, expected, "{state}, {threads}");
        }
        assert_eq!(ProcessStat::parse(""), None);
    }
}
