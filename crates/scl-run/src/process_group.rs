//! The processes of a program's group: its first process and those that it has started, as `/proc` shows them.

use super::process_stat::{ProcessStat, all_processes};
use rustix::process::{Pid, Signal, kill_process};
use std::collections::HashSet;
use std::fs;
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

/// The first pause between two looks at processes that were asked to end. They grow to `MAX_PAUSE`.
pub(crate) const PAUSE: Duration = Duration::from_millis(20);
const MAX_PAUSE: Duration = Duration::from_secs(1);

/// Makes sure that each process of the group receives the signal by which the group was asked to end. Returns when all
/// processes have ended.
///
/// One signal to the group is not enough: a shell may start a program after it has noted the signal, or note it in the
/// copy of itself that becomes the program. So a program that was not running when the signal was sent (`reached` are
/// the [`programs`] that were), and that the signal would end, receives it, too. No program receives it twice: a second
/// signal would end an SCL program at once, and others restore the default action after the first.
pub(crate) fn repeat_where_missed(group: Pid, signal: Signal, reached: HashSet<Program>) {
    let mut repeats = Repeats { group, signal, reached, terminated: HashSet::new() };
    look_while(|| repeats.look());
}

/// Calls `look` at growing intervals while it returns true.
pub(crate) fn look_while(mut look: impl FnMut() -> bool) {
    let mut pause = PAUSE;
    while look() {
        thread::sleep(pause);
        pause = MAX_PAUSE.min(2 * pause);
    }
}

struct Repeats {
    group: Pid,
    signal: Signal,
    /// The programs that have received the signal, or have been seen to block or catch it.
    reached: HashSet<Program>,
    /// The processes that ignore the signal and received SIGTERM after the first process had ended: a shell lets its
    /// background processes ignore SIGINT.
    terminated: HashSet<Pid>,
}

impl Repeats {
    /// Repeats the signal where it was missed. Returns false if every process has ended.
    fn look(&mut self) -> bool {
        let processes = members(self.group);
        for process in processes.iter().copied() {
            let Some(program) = program(process) else { continue };
            let repeated = match disposition(process, self.signal) {
                Disposition::Ends => self.reached.insert(program).then_some(self.signal),
                Disposition::Handles => {
                    self.reached.insert(program);
                    None
                }
                Disposition::Ignores => {
                    let is_left = !processes.contains(&self.group);
                    (is_left && self.terminated.insert(process)).then_some(Signal::TERM)
                }
            };
            // Ignore errors: the process may have just ended.
            let _ = repeated.map(|signal| kill_process(process, signal));
        }
        !processes.is_empty()
    }
}

/// What a process executes. The value changes with `exec`, which starts the program with a stack elsewhere.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Program {
    process: Pid,
    executable: PathBuf,
    stack: String,
}

/// The programs of the group.
pub(crate) fn programs(group: Pid) -> HashSet<Program> {
    members(group).into_iter().filter_map(program).collect()
}

/// Returns what a process executes, or `None` if it has ended.
fn program(process: Pid) -> Option<Program> {
    // Empty if the process belongs to another user.
    let executable = fs::read_link(format!("/proc/{process}/exe")).unwrap_or_default();
    Some(Program { process, executable, stack: ProcessStat::of(process)?.stack })
}

/// The processes of the group that a signal has stopped.
pub(crate) fn stopped(group: Pid) -> Vec<Pid> {
    let is_stopped = |process: &Pid| ProcessStat::of(*process).is_some_and(|stat| stat.is_stopped);
    members(group).into_iter().filter(is_stopped).collect()
}

/// The running processes of the group. Empty only if there are none.
fn members(group: Pid) -> Vec<Pid> {
    let is_member = |process: &Pid| ProcessStat::of(*process).is_some_and(|stat| stat.group == Some(group));
    let look = || -> Vec<Pid> { all_processes().filter(is_member).collect() };
    let seen = look();
    // Look again: a process may have started another one where the first look had already passed, and have ended before
    // that look reached it.
    if seen.is_empty() { look() } else { seen }
}

/// What a process does with a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Disposition {
    Ends,
    Handles,
    Ignores,
}

/// Reads the masks in `/proc/<pid>/status`. A blocked signal counts as handled, because a process that waits for a
/// signal blocks it. So do signals of a process that has ended, which has no masks.
fn disposition(process: Pid, signal: Signal) -> Disposition {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let mask = |name: &str| {
        let mask = status.lines().find_map(|line| line.strip_prefix(name))?;
        u64::from_str_radix(mask.trim(), 16).ok()
    };
    let is_set = |name: &str| mask(name).is_none_or(|mask| mask >> (signal.as_raw() - 1) & 1 == 1);
    match () {
        () if is_set("SigBlk:") || is_set("SigCgt:") => Disposition::Handles,
        () if is_set("SigIgn:") => Disposition::Ignores,
        () => Disposition::Ends,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};
    use std::os::unix::process::CommandExt;
    use std::process::{Command, Stdio};

    /// A shell that is told to end while it starts a program.
    #[test]
    fn a_process_that_missed_the_signal_gets_it() {
        let script =
            "trap 'tail -f /dev/null & exit 0' TERM; (trap '' TERM; exec tail -f /dev/null) & echo ready; wait";
        let mut leader = Command::new("/bin/sh");
        let leader = leader.args(["-c", script]).process_group(0).stdin(Stdio::null()).stdout(Stdio::piped());
        let mut leader = leader.spawn().unwrap();
        let group = Pid::from_child(&leader);
        leader.stdout.as_mut().unwrap().read_exact(&mut [0; 6]).unwrap();
        let ignoring =
            || members(group).into_iter().find(|process| disposition(*process, Signal::TERM) == Disposition::Ignores);
        let deaf = loop {
            if let Some(process) = ignoring() {
                break process;
            }
        };
        kill_process(group, Signal::TERM).unwrap();
        let ended = thread::spawn(move || repeat_where_missed(group, Signal::TERM, HashSet::new()));
        while members(group) != [deaf] {}
        kill_process(deaf, Signal::KILL).unwrap();
        ended.join().unwrap();
        leader.wait().unwrap();
    }

    /// A program that restores the default action after the signal, so that a second one ends it at once.
    #[test]
    fn a_program_that_has_got_the_signal_does_not_get_it_again() {
        let script = "\
trap 'trap - TERM; echo asked; read line; echo closed; exit 0' TERM
echo ready
while :; do :; done";
        let mut program = Command::new("/bin/sh");
        let program = program.args(["-c", script]).process_group(0).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut program = program.spawn().unwrap();
        let group = Pid::from_child(&program);
        let (mut output, mut input) = (program.stdout.take().unwrap(), program.stdin.take().unwrap());
        output.read_exact(&mut [0; 6]).unwrap();
        let reached = programs(group);
        kill_process(group, Signal::TERM).unwrap();
        output.read_exact(&mut [0; 6]).unwrap();
        assert_eq!(disposition(group, Signal::TERM), Disposition::Ends);
        let mut repeats = Repeats { group, signal: Signal::TERM, reached, terminated: HashSet::new() };
        for _ in 0..3 {
            assert!(repeats.look());
        }
        input.write_all(b"end\n").unwrap();
        let mut rest = String::new();
        output.read_to_string(&mut rest).unwrap();
        assert_eq!(rest, "closed\n");
        assert!(program.wait().unwrap().success());
        assert!(!repeats.look());
    }
}
