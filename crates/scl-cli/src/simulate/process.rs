//! The process of a simulation, seen from outside.

use super::ChosenFaults;
use rustix::process::{Pid, Signal, kill_process};
use scl_terminal::Problem;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::ffi::OsStr;
use std::io;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::thread;
use tempfile::TempDir;

/// The hidden command that is one simulation: `scl __simulate PARENT FOLDER OPTIONS... ARGUMENTS...`.
pub(crate) const RUN_WORD: &str = "__simulate";

/// What a simulation does other than the arguments of this command say.
#[derive(Debug, Clone, Default)]
pub(super) struct Process<'a> {
    /// The file into which it is recorded.
    pub(super) output: Option<&'a Path>,
    /// Whether its programs are built already.
    pub(super) is_built: bool,
    /// Its seed.
    pub(super) seed: Option<u64>,
    /// The faults that happen.
    pub(super) faults: Option<ChosenFaults>,
    /// The file into which it reports; it prints nothing then.
    pub(super) report: Option<&'a Path>,
    /// Which of the allowed processors it uses, counted from the last.
    pub(super) processor: usize,
}

impl Process<'_> {
    /// Runs the simulation to its end, and passes on to it the signals that ask to stop.
    pub(super) fn run(&self) -> Result<ExitCode, Problem> {
        let code = self.run_to_end()?;
        Ok(ExitCode::from(code))
    }

    /// Returns the exit code.
    pub(super) fn run_to_end(&self) -> Result<u8, Problem> {
        let folder = folder()?;
        let mut signals = Signals::new([SIGHUP, SIGINT, SIGTERM]).map_err(|error| failed("handle signals", error))?;
        let mut command = Command::new("/proc/self/exe");
        command.arg0("scl").arg(RUN_WORD).arg(std::process::id().to_string()).arg(folder.path());
        self.add_options(&mut command);
        command.args(std::env::args_os().skip(2));
        // A group of its own, so that Ctrl-C reaches it only once.
        command.env("SCL_RUNTIME_DIR", folder.path()).process_group(0);
        if self.report.is_some() {
            command.stdout(Stdio::null()).stderr(Stdio::null());
        }
        #[expect(clippy::disallowed_methods, reason = "it is waited for below")]
        let mut process = command.spawn().map_err(|error| failed("start the simulation", error))?;
        let simulation = Pid::from_child(&process);
        let handle = signals.handle();
        let passing_on = thread::spawn(move || {
            let mut stopped = false;
            for signal in signals.forever().filter_map(Signal::from_named_raw) {
                stopped = true;
                // It may have just ended.
                let _ended = kill_process(simulation, signal);
            }
            stopped
        });
        let ended = process.wait().map_err(|error| failed("wait for the simulation", error))?;
        handle.close();
        let was_stopped = passing_on.join().unwrap_or(false);
        if was_stopped && self.report.is_some() {
            return Err(Problem::new("stopped before all seeds were simulated"));
        }
        let code = ended.code().and_then(|code| u8::try_from(code).ok());
        code.ok_or_else(|| Problem::new(format!("the simulation was ended by {ended}")))
    }

    fn add_options(&self, command: &mut Command) {
        let mut add = |option: &str, value: Option<&OsStr>| {
            command.args(value.iter().flat_map(|value| [OsStr::new(option), value]));
        };
        let (seed, faults) = (self.seed.map(|seed| seed.to_string()), self.faults.as_ref().map(ChosenFaults::text));
        add("--record-to", self.output.map(Path::as_os_str));
        add("--report-to", self.report.map(Path::as_os_str));
        add("--with-seed", seed.as_deref().map(OsStr::new));
        add("--with-faults", faults.as_deref().map(OsStr::new));
        add("--processor", Some(self.processor.to_string().as_ref()));
        command.args(self.is_built.then_some("--built"));
    }
}

/// A folder for the files of a simulation.
pub(super) fn folder() -> Result<TempDir, Problem> {
    tempfile::Builder::new().prefix("scl-").tempdir().map_err(|error| failed("create a folder", error))
}

pub(super) fn failed(what: &str, error: io::Error) -> Problem {
    Problem::new(format!("cannot {what}: {error}"))
}
