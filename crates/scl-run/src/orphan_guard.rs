//! Leaves no orphans, even when `scl run` itself is killed with SIGKILL.
//!
//! Two mechanisms, because each one has a gap:
//!
//! - Every component is started through `scl __start`, which asks the kernel to be killed when `scl run` ends, and
//!   then becomes the program. This holds from the first moment, but only for the program itself.
//! - One `scl __guard` holds the read end of a pipe whose write end only `scl run` holds. When the pipe ends, it kills
//!   the whole process group of each component, and all processes that come from the programs of this run.

use super::conductor::Seat;
use super::family::{kill_run, run_mark};
use super::orphans;
use super::placement::Placement;
use super::seat::SeatArgument;
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
use scl_terminal::print_err;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use std::collections::HashSet;
use std::ffi::OsString;
use std::io::{self, BufRead, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, Command, ExitCode, Stdio};
use std::sync::Arc;

/// The hidden command that starts one component: `scl __start PARENT [--cpu N]... [--fifo N] [--descriptors N]
/// [--seat SEAT] -- COMMAND...`.
pub const START_WORD: &str = "__start";
/// The hidden command that keeps watch: `scl __guard MARK`.
pub const GUARD_WORD: &str = "__guard";

/// The exit code of shells for a program that exists but cannot be executed.
const CANNOT_EXECUTE: u8 = 126;

/// Returns the command that starts `command` in such a way that it is killed when this process ends.
pub(crate) fn bound_command(command: &[OsString], placement: &Placement, seat: Option<&Seat>) -> Command {
    let mut bound = this_program();
    bound.arg(START_WORD).arg(std::process::id().to_string()).args(placement.arguments());
    bound.args(seat.iter().flat_map(|seat| seat.arguments())).arg("--").args(command);
    bound
}

/// The path of the running `scl`, even if a build has replaced its file.
pub(crate) const THIS_PROGRAM: &str = "/proc/self/exe";

/// Returns a command that starts the running `scl` again.
pub(crate) fn this_program() -> Command {
    let mut command = Command::new(THIS_PROGRAM);
    command.arg0("scl");
    command
}

/// The body of `scl __start`: becomes the program `command`, which ends when the process `parent` ends. Returns only if
/// the program cannot be executed.
pub fn start_component(
    parent: u32,
    placement: &Placement,
    seat: Option<&SeatArgument>,
    command: &[OsString],
) -> ExitCode {
    if let Err(error) = set_parent_process_death_signal(Some(Signal::KILL)) {
        print_err(&format!("scl: cannot prepare the start: {error}\n"));
        return ExitCode::from(CANNOT_EXECUTE);
    }
    // If the parent ended before the call to prctl, nothing would ever stop this program.
    if getppid().is_none_or(|current| current.as_raw_pid().cast_unsigned() != parent) {
        return ExitCode::from(CANNOT_EXECUTE);
    }
    let [program, rest @ ..] = command else { return ExitCode::from(CANNOT_EXECUTE) };
    let seated = seat.map(SeatArgument::take).unwrap_or_default();
    let error = Command::new(program).args(rest).envs(placement.apply()).envs(seated).exec();
    print_err(&format!("scl: cannot execute `{}`: {error}\n", program.display()));
    ExitCode::from(CANNOT_EXECUTE)
}

/// The signals by which `scl run` is asked to stop.
pub(crate) const STOP_SIGNALS: [i32; 3] = [SIGINT, SIGTERM, SIGHUP];

/// The process that watches this one. Dropping this value makes it kill the process groups added so far.
#[derive(Debug)]
pub(crate) struct OrphanGuard {
    process: Child,
    pipe: Option<ChildStdin>,
    /// The mark of the processes that it kills besides the groups.
    pub(crate) run_mark: String,
}

impl OrphanGuard {
    /// Starts the guard in a separate process group, so that Ctrl-C does not reach it.
    ///
    /// # Errors
    ///
    /// If no process can be started.
    pub(crate) fn start() -> io::Result<Self> {
        let run_mark = run_mark()?;
        let mut command = this_program();
        let command = command.args([GUARD_WORD, &run_mark]).process_group(0);
        let command = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
        let mut process = orphans::spawn(command)?;
        let pipe = process.stdin.take();
        Ok(Self { process, pipe, run_mark })
    }

    /// Adds the process group of a component that has just been started.
    ///
    /// # Errors
    ///
    /// If the guard has ended.
    pub(crate) fn watch(&mut self, group: Pid) -> io::Result<()> {
        self.tell(group.as_raw_pid())
    }

    /// Removes a process group that is about to be reaped: its number may be reused afterwards.
    pub(crate) fn forget(&mut self, group: Pid) {
        // Ignore errors: a guard that has ended kills nothing.
        let _ = self.tell(-group.as_raw_pid());
    }

    fn tell(&mut self, number: i32) -> io::Result<()> {
        let pipe = self.pipe.as_mut().ok_or(io::ErrorKind::BrokenPipe)?;
        pipe.write_all(format!("{number}\n").as_bytes())
    }
}

impl Drop for OrphanGuard {
    fn drop(&mut self) {
        // Close the pipe first: the guard runs until it is closed.
        drop(self.pipe.take());
        orphans::wait(&mut self.process);
    }
}

/// The body of `scl __guard`: reads the numbers of process groups until the pipe is closed, then kills these groups and
/// every process with the mark of the run. The negative of a group's number removes that group.
pub fn keep_watch(run_mark: &str) -> ExitCode {
    // Ignore stop signals: if this `scl run` is itself run by another one, that one sends them to all processes, but
    // the guard has to be the last to end.
    let _ = STOP_SIGNALS.map(|signal| flag::register(signal, Arc::default()));
    let mut groups = HashSet::new();
    for number in io::stdin().lock().lines().map_while(Result::ok).filter_map(|line| line.parse::<i32>().ok()) {
        let Some(group) = Pid::from_raw(number.saturating_abs()) else { continue };
        if number > 0 {
            groups.insert(group)
        } else {
            groups.remove(&group)
        };
    }
    kill_run(&groups, run_mark);
    ExitCode::SUCCESS
}
