//! The processes of a program's group: its first process and those that it has started, as `/proc` shows them.

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::process::{PidfdFlags, pidfd_open};
use std::collections::HashSet;
use std::fs;
use std::thread;
use std::time::Duration;

/// The pause before another look where the end of a process cannot be waited for: out of file descriptors, which passes.
/// Also the first of those between two looks at processes that may have missed a signal, which grow to `MAX_PAUSE`.
const PAUSE: Duration = Duration::from_millis(20);
const MAX_PAUSE: Duration = Duration::from_secs(1);

/// Whether every process of the group has ended. Ended ones that nobody has reaped do not count.
pub(crate) fn is_empty(group: Pid) -> bool {
    // A process may start another one behind the first look and end before that look comes to it.
    members(group).is_empty() && members(group).is_empty()
}

/// Waits until every process of the group has ended.
pub(crate) fn wait_until_empty(group: Pid) {
    while !is_empty(group) {
        members(group).into_iter().for_each(|process| wait_for_end(process, group));
    }
}

/// Sees that each process of the group gets a signal that was sent to it and that asks it to end; returns when all have ended.
///
/// One signal to the group is not enough: a shell may start a program after it has noted the signal, or note it in the copy of
/// itself that becomes the program. So a process that would have been ended by the signal gets it again. One that handles it
/// does not: a second signal would end a program of SCL at once. When the first process has ended, those that ignore the
/// signal get SIGTERM: a shell lets its background processes ignore SIGINT.
pub(crate) fn repeat_where_missed(group: Pid, signal: Signal) {
    let mut terminated = HashSet::new();
    let mut pause = PAUSE;
    loop {
        // Another look, as in `is_empty`.
        let mut processes = members(group);
        if processes.is_empty() {
            processes = members(group);
        }
        if processes.is_empty() {
            return;
        }
        for process in processes.iter().copied() {
            // It may end at this moment.
            let _ = match disposition(process, signal) {
                Disposition::Ends => kill(process, signal),
                Disposition::Ignores if !processes.contains(&group) && terminated.insert(process) => {
                    kill(process, Signal::SIGTERM)
                }
                Disposition::Ignores | Disposition::Handles => Ok(()),
            };
        }
        thread::sleep(pause);
        pause = MAX_PAUSE.min(2 * pause);
    }
}

fn members(group: Pid) -> Vec<Pid> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    let processes = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok().map(Pid::from_raw));
    processes.filter(|process| is_member(*process, group)).collect()
}

fn is_member(process: Pid, group: Pid) -> bool {
    let stat = fs::read_to_string(format!("/proc/{process}/stat"));
    stat.is_ok_and(|stat| living_group(&stat) == Some(group.as_raw()))
}

/// The group of a process from its `/proc/<pid>/stat`, as in `proc_pid_stat(5)`; `None` if it has ended.
fn living_group(stat: &str) -> Option<i32> {
    // The name of the program, in parentheses, may contain anything.
    let mut fields = stat.rsplit_once(')')?.1.split_ascii_whitespace();
    let (state, group) = (fields.next()?, fields.nth(1)?);
    let threads: usize = fields.nth(14)?.parse().ok()?;
    // A process whose main thread has ended before the others is shown like one that has ended.
    let has_ended = matches!(state, "Z" | "X" | "x") && threads <= 1;
    if has_ended { None } else { group.parse().ok() }
}

fn wait_for_end(process: Pid, group: Pid) {
    let Some(id) = rustix::process::Pid::from_raw(process.as_raw()) else { return };
    match pidfd_open(id, PidfdFlags::empty()) {
        // Another process may have got the number meanwhile.
        Ok(process_fd) if is_member(process, group) => {
            let _ = poll(&mut [PollFd::new(&process_fd, PollFlags::IN)], None);
        }
        Ok(_) | Err(rustix::io::Errno::SRCH) => {}
        Err(_) => thread::sleep(PAUSE),
    }
}

/// What a process does with a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Disposition {
    Ends,
    Handles,
    Ignores,
}

/// From the masks of `/proc/<pid>/status`. A process that waits for a signal blocks it, and handles it. One that has ended
/// has no masks.
fn disposition(process: Pid, signal: Signal) -> Disposition {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let mask = |name: &str| {
        let mask = status.lines().find_map(|line| line.strip_prefix(name))?;
        u64::from_str_radix(mask.trim(), 16).ok()
    };
    let is_set = |name: &str| mask(name).is_none_or(|mask| mask >> (signal as i32 - 1) & 1 == 1);
    match () {
        () if is_set("SigBlk:") || is_set("SigCgt:") => Disposition::Handles,
        () if is_set("SigIgn:") => Disposition::Ignores,
        () => Disposition::Ends,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use std::os::unix::process::CommandExt;
    use std::process::{Command, Stdio};

    #[test]
    fn the_state_and_the_threads_decide_whether_a_process_lives() {
        let stat = |state, threads| format!("7 (a) b) c) {state} 1 42 3 0 -1 4 5 6 7 8 9 10 11 12 20 0 {threads} 0 99");
        let cases = [("S", 1, Some(42)), ("T", 1, Some(42)), ("Z", 1, None), ("X", 1, None), ("Z", 3, Some(42))];
        for (state, threads, expected) in cases {
            assert_eq!(living_group(&stat(state, threads)), expected, "{state}, {threads}");
        }
        assert_eq!(living_group(""), None);
    }

    #[test]
    fn a_group_lives_as_long_as_one_of_its_processes() {
        let script = "exec 3<&0; trap '' INT; (echo ready; read line <&3) & exit 0";
        let mut leader = Command::new("/bin/sh");
        let leader = leader.args(["-c", script]).process_group(0).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut leader = leader.spawn().unwrap();
        let group = Pid::from_raw(leader.id().cast_signed());
        let (mut ready, go) = ([0; 6], leader.stdin.take());
        leader.stdout.as_mut().unwrap().read_exact(&mut ready).unwrap();
        // Not reaped, so the number stays that of the group.
        assert!(!is_empty(group));
        let rest = members(group).into_iter().find(|process| *process != group).unwrap();
        assert_eq!(disposition(rest, Signal::SIGINT), Disposition::Ignores);
        assert_eq!(disposition(rest, Signal::SIGTERM), Disposition::Ends);
        drop(go);
        wait_until_empty(group);
        assert!(is_empty(group));
        leader.wait().unwrap();
    }

    /// A shell that is told to end while it starts a program.
    #[test]
    fn a_process_that_missed_the_signal_gets_it() {
        let script =
            "trap 'tail -f /dev/null & exit 0' TERM; (trap '' TERM; exec tail -f /dev/null) & echo ready; wait";
        let mut leader = Command::new("/bin/sh");
        let leader = leader.args(["-c", script]).process_group(0).stdin(Stdio::null()).stdout(Stdio::piped());
        let mut leader = leader.spawn().unwrap();
        let group = Pid::from_raw(leader.id().cast_signed());
        leader.stdout.as_mut().unwrap().read_exact(&mut [0; 6]).unwrap();
        let ignoring = || {
            members(group).into_iter().find(|process| disposition(*process, Signal::SIGTERM) == Disposition::Ignores)
        };
        let deaf = loop {
            if let Some(process) = ignoring() {
                break process;
            }
        };
        kill(group, Signal::SIGTERM).unwrap();
        let ended = thread::spawn(move || repeat_where_missed(group, Signal::SIGTERM));
        while members(group) != [deaf] {}
        kill(deaf, Signal::SIGKILL).unwrap();
        ended.join().unwrap();
        leader.wait().unwrap();
    }
}
