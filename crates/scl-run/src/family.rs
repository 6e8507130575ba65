//! All processes that descend from a program, including those that have left its process group, as with `setsid`.
//!
//! They are found in three ways: by the group, by the parent of each process, and by a mark in the environment, which
//! remains when the parent ends. A process that has left the group, cleared its environment and lost its parent before
//! a look has found it is missed.

use super::lock::lock;
use super::process_group::{PAUSE, look_while};
use super::process_stat::{ProcessStat, running_processes};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::process::{Pid, PidfdFlags, Signal, getpid, kill_process, kill_process_group, pidfd_open};
use std::collections::{HashMap, HashSet};
use std::fs;
use std::io;
use std::sync::Mutex;
use std::thread;

/// The variable with the mark: the mark of the run, followed by the number of the program in it. If one `scl run` is a
/// program of another one, the variable contains the marks of both.
pub(crate) const MARK: &str = "SCL_STARTED_BY";

/// Returns the mark of all processes that this `scl run` starts. The mark of a program is this mark, followed by the
/// number of the program.
///
/// # Errors
///
/// If `/proc` cannot be read.
pub(crate) fn run_mark() -> io::Result<String> {
    let process = getpid();
    let stat = ProcessStat::of(process).ok_or_else(|| io::Error::other("`/proc` does not show this process"))?;
    Ok(format!("{process}.{}.", stat.started))
}

/// Returns the value of [`MARK`] for a program with this mark: it follows the marks that this process has inherited.
pub(crate) fn with_inherited(mark: &str) -> String {
    match std::env::var(MARK) {
        Ok(inherited) if !inherited.is_empty() => format!("{inherited},{mark}"),
        _ => mark.to_owned(),
    }
}

/// A program's processes.
#[derive(Debug)]
pub(crate) struct Family {
    group: Pid,
    mark: String,
    /// No process of the family is older than this.
    since: u64,
    /// The processes that the last look found, with their start times. They are found again even if their parents have
    /// ended.
    known: Mutex<HashMap<Pid, u64>>,
}

impl Family {
    /// Creates the family of a program whose first process was just started, in a separate group.
    pub(crate) fn new(group: Pid, mark: String) -> Self {
        let since = ProcessStat::of(group).map_or(0, |stat| stat.started);
        Self { group, mark, since, known: Mutex::default() }
    }

    /// Looks for its running processes, and remembers them.
    pub(crate) fn look(&self) -> HashMap<Pid, ProcessStat> {
        let mut known = lock(&self.known);
        let found = relatives(running_processes(), |process, stat| {
            let is_known = known.get(&process) == Some(&stat.started);
            is_known || stat.group == Some(self.group) || (stat.started >= self.since && has_mark(process, &self.mark))
        });
        *known = found.iter().map(|(process, stat)| (*process, stat.started)).collect();
        found
    }

    /// Whether every process has ended.
    pub(crate) fn is_empty(&self) -> bool {
        // Look again: a process may have started another one where the first look had already passed, and have ended
        // before that look reached it.
        self.look().is_empty() && self.look().is_empty()
    }

    /// Waits until every process has ended.
    pub(crate) fn wait_until_empty(&self) {
        while !self.is_empty() {
            self.look().into_iter().for_each(|(process, stat)| wait_for_end(process, stat.started));
        }
    }

    /// Asks the processes that have left the group to end, once each, and returns when all have ended. Called after the
    /// group has ended.
    pub(crate) fn end_rest(&self) {
        let mut asked = HashSet::new();
        look_while(|| {
            for (process, stat) in self.look() {
                if asked.insert((process, stat.started)) {
                    // Ignore errors: the process may have just ended.
                    let _ = kill_process(process, Signal::TERM);
                    // A stopped process handles SIGTERM only when it continues.
                    let _ = kill_process(process, Signal::CONT);
                }
            }
            !self.is_empty()
        });
    }

    /// Kills all processes of the family.
    pub(crate) fn kill(&self) {
        // Ignore errors: the group may contain only the program, which has ended.
        let _ = kill_process_group(self.group, Signal::KILL);
        kill_all(|| self.look());
    }
}

fn wait_for_end(process: Pid, started: u64) {
    match pidfd_open(process, PidfdFlags::empty()) {
        // Compare the start times: the process id may have been reused.
        Ok(process_fd) if ProcessStat::of(process).is_some_and(|stat| stat.started == started) => {
            let _ = poll(&mut [PollFd::new(&process_fd, PollFlags::IN)], None);
        }
        Ok(_) | Err(rustix::io::Errno::SRCH) => {}
        // Probably out of file descriptors; the caller looks again.
        Err(_) => thread::sleep(PAUSE),
    }
}

/// Kills the processes of these groups, the processes with a mark of this run, and their descendants.
pub(crate) fn kill_run(groups: &HashSet<Pid>, run_mark: &str) {
    for group in groups {
        // Ignore errors: the group has usually ended already.
        let _ = kill_process_group(*group, Signal::KILL);
    }
    kill_all(|| {
        relatives(running_processes(), |process, stat| {
            stat.group.is_some_and(|group| groups.contains(&group)) || has_mark(process, run_mark)
        })
    });
}

/// Kills the processes that `look` finds, and looks again until it finds no new one: they may start others before they
/// end.
pub(crate) fn kill_all(look: impl Fn() -> HashMap<Pid, ProcessStat>) {
    let mut killed = HashSet::new();
    loop {
        let before = killed.len();
        for (process, stat) in look() {
            if killed.insert((process, stat.started)) {
                let _ = kill_process(process, Signal::KILL);
            }
        }
        if killed.len() == before {
            return;
        }
    }
}

/// The processes for which `is_root` returns true, and their descendants.
pub(crate) fn relatives(
    mut processes: HashMap<Pid, ProcessStat>,
    is_root: impl Fn(Pid, &ProcessStat) -> bool,
) -> HashMap<Pid, ProcessStat> {
    let mut found = HashMap::new();
    loop {
        let is_found = |process: &Pid, stat: &mut ProcessStat| match found.is_empty() {
            true => is_root(*process, stat),
            false => stat.parent.is_some_and(|parent| found.contains_key(&parent)),
        };
        let more: HashMap<_, _> = processes.extract_if(is_found).collect();
        if more.is_empty() {
            return found;
        }
        found.extend(more);
    }
}

/// Whether the environment of a process has this mark; the mark of a run also matches the marks of its programs. False
/// for processes of other users, whose environment cannot be read.
fn has_mark(process: Pid, mark: &str) -> bool {
    let environment = fs::read(format!("/proc/{process}/environ")).unwrap_or_default();
    let marks = environment
        .split(|byte| *byte == 0)
        .find_map(|variable| variable.strip_prefix(MARK.as_bytes())?.strip_prefix(b"="));
    // The mark of a run ends with a dot and is a prefix. The mark of a program must match as a whole, so that program 1
    // does not match program 12.
    let is_meant =
        |found: &[u8]| if mark.ends_with('.') { found.starts_with(mark.as_bytes()) } else { found == mark.as_bytes() };
    marks.is_some_and(|marks| marks.split(|byte| *byte == b',').any(is_meant))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read as _, Write as _};
    use std::os::unix::process::CommandExt;
    use std::process::{Command, Stdio};

    #[test]
    fn a_family_lives_as_long_as_one_of_its_processes() {
        // One in the group, and one in a session of its own without an environment, whose parent has ended.
        for rest in ["(echo ready; read line <&3)", "env -i setsid sh -c 'echo ready; read line <&3'"] {
            let mut leader = Command::new("/bin/sh");
            let script = format!("exec 3<&0; {rest} & read line; exit 0");
            let leader = leader.args(["-c", &script]).process_group(0).stdin(Stdio::piped()).stdout(Stdio::piped());
            let mut leader = leader.spawn().unwrap();
            let group = Pid::from_child(&leader);
            let family = Family::new(group, "none".to_owned());
            leader.stdout.as_mut().unwrap().read_exact(&mut [0; 6]).unwrap();
            assert!(family.look().len() > 1, "{rest}");
            let mut go = leader.stdin.take().unwrap();
            // A line for whichever reads first. Not reaped, so the number stays that of the group.
            go.write_all(b"\n").unwrap();
            assert!(!family.is_empty());
            drop(go);
            family.wait_until_empty();
            leader.wait().unwrap();
        }
    }

    #[test]
    fn a_mark_is_found_as_a_whole() {
        let mut marked = Command::new("/bin/sh");
        let marked = marked.args(["-c", "echo ready; read line"]).env(MARK, "3.50.1,7.99.12");
        let mut marked = marked.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let process = Pid::from_child(&marked);
        marked.stdout.as_mut().unwrap().read_exact(&mut [0; 6]).unwrap();
        for (mark, expected) in
            [("7.99.12", true), ("7.99.1", false), ("7.99.", true), ("7.9", false), ("3.50.1", true), ("9.12", false)]
        {
            assert_eq!(has_mark(process, mark), expected, "{mark}");
        }
        drop(marked.stdin.take());
        marked.wait().unwrap();
    }

    #[test]
    fn descendants_are_found_whatever_their_numbers() {
        let processes = [(2, 1), (3, 9), (4, 3), (5, 1), (6, 5), (9, 2), (10, 6), (11, 2)];
        let processes = processes.into_iter().map(|(process, parent)| {
            (Pid::from_raw(process).unwrap(), ProcessStat::with_parent(Pid::from_raw(parent)))
        });
        let found = relatives(processes.collect(), |process, _| Some(process) == Pid::from_raw(2));
        let mut found: Vec<i32> = found.keys().map(|process| process.as_raw_pid()).collect();
        found.sort();
        assert_eq!(found, [2, 3, 4, 9, 11]);
    }
}
