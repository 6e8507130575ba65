//! The client side of the control socket: finds every `scl run` and sends it requests.

use super::super::own_file::{connect, process_of, sockets_in};
use super::super::process_stat::ProcessStat;
use super::protocol::{Command, Request, Response};
use rustix::process::Pid;
use scl_terminal::Problem;
use std::fs;
use std::io::{self, BufRead, BufReader, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// How long a running `scl run` may take to report the states of its components. It answers at once unless it hangs.
const PATIENCE: Duration = Duration::from_secs(10);

/// Interval at which the process is checked while its answer is pending.
const LOOK: Duration = Duration::from_millis(500);

/// Maximum number of attempts to send a request: a `scl run` with too many silent clients disconnects the oldest.
const ATTEMPTS: usize = 3;

/// A `scl run` that can be asked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ControlledRun {
    /// The system whose components it runs.
    pub system: String,
    /// Its process id.
    pub process: u32,
    socket: PathBuf,
}

/// Why there is no answer.
#[derive(Debug)]
#[non_exhaustive]
pub enum NoAnswer {
    /// The `scl run` has ended.
    Ended,
    /// Its process is stopped, by SIGSTOP or a debugger.
    Stopped,
    /// It has not answered in time.
    Silent,
    /// The connection failed.
    Io(io::Error),
}

/// Returns every `scl run` that is reachable by a socket in a system's folder below the runtime folder, or only those
/// of `system` if it is given.
pub fn find_runs(runtime_folder: &Path, system: Option<&str>) -> Vec<ControlledRun> {
    let folders = fs::read_dir(runtime_folder).into_iter().flatten().flatten();
    let names = folders.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(|name| system.is_none_or(|system| system == name)).collect();
    names.sort();
    let runs = names.iter().flat_map(|name| {
        let sockets = sockets_in(&runtime_folder.join(name), "control");
        let run = |socket: PathBuf| {
            Some(ControlledRun { system: name.clone(), process: process_of(&socket, "control")?, socket })
        };
        sockets.into_iter().filter_map(run)
    });
    // Connecting without sending a request has no effect on a run. A run that cannot accept at the moment
    // (`WouldBlock`) is running, too.
    let is_there = |error: io::Error| error.kind() == ErrorKind::WouldBlock;
    runs.filter(|run| connect(&run.socket).map_or_else(is_there, |_| true)).collect()
}

impl ControlledRun {
    /// Sends a request and waits for its response. Gives up if the `scl run` ends, is stopped, or hangs.
    ///
    /// # Errors
    ///
    /// [`NoAnswer`] gives the reason.
    pub fn ask(&self, request: &Request) -> Result<Response, NoAnswer> {
        let line = serde_json::to_string(request).map_err(|error| NoAnswer::Io(error.into()))?;
        let mut answered = self.try_ask(request.command, &line);
        for _ in 1..ATTEMPTS {
            if matches!(answered, Err(NoAnswer::Ended)) && connect(&self.socket).is_ok() {
                answered = self.try_ask(request.command, &line);
            }
        }
        answered
    }

    /// Returns the problem that reports a missing answer.
    pub(crate) fn problem(&self, error: &NoAnswer) -> Problem {
        let process = self.process;
        let kill = format!("end it and its programs: `kill -KILL {process}`");
        match error {
            NoAnswer::Ended => Problem::new(format!("`scl run`, process {process}, ended before it answered")),
            NoAnswer::Stopped => Problem::new(format!("`scl run`, process {process}, does not answer: it is stopped"))
                .help(format!("resume it: `kill -CONT {process}`"))
                .help(kill),
            NoAnswer::Silent => {
                let text = format!("`scl run`, process {process}, has not answered for {} s", PATIENCE.as_secs());
                Problem::new(text).help(kill)
            }
            NoAnswer::Io(error) => Problem::new(format!("no answer from `scl run`, process {process}: {error}")),
        }
    }

    /// Returns a problem if this run belongs to the topology file `running`, but the user means `meant`. Either is
    /// `None` if its system has a name of its own, so that the two cannot be confused.
    pub(crate) fn other_system(&self, running: Option<&Path>, meant: Option<&Path>) -> Option<Problem> {
        let (running, meant) = running.zip(meant).filter(|(running, meant)| running != meant)?;
        let (running, meant, process) = (running.display(), meant.display(), self.process);
        let text = format!("`scl run`, process {process}, runs the system of `{running}`, not that of `{meant}`");
        let problem = Problem::new(text).note("neither file has a `system`, so each system is named after its file");
        Some(problem.help(format!("name it: `system: ...` in `{meant}`")))
    }

    fn try_ask(&self, command: Command, line: &str) -> Result<Response, NoAnswer> {
        let began = Instant::now();
        let mut connection = loop {
            match connect(&self.socket) {
                Ok(connection) => break connection,
                // The backlog of the socket is full.
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    self.look(Command::List, began)?;
                    thread::sleep(LOOK);
                }
                Err(_) => return Err(NoAnswer::Ended),
            }
        };
        connection.set_read_timeout(Some(LOOK)).map_err(NoAnswer::Io)?;
        if connection.write_all(format!("{line}\n").as_bytes()).is_err() {
            return Err(NoAnswer::Ended);
        }
        let (mut reader, mut answer) = (BufReader::new(connection), Vec::new());
        let mut began = Instant::now();
        loop {
            match reader.read_until(b'\n', &mut answer) {
                Ok(_) if answer.ends_with(b"\n") => {
                    return serde_json::from_slice(&answer).map_err(|error| NoAnswer::Io(error.into()));
                }
                Ok(_) => return Err(NoAnswer::Ended),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    self.look(command, began)?;
                    if began.elapsed() >= PATIENCE {
                        began = Instant::now();
                    }
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::ConnectionReset => return Err(NoAnswer::Ended),
                Err(error) => return Err(NoAnswer::Io(error)),
            }
        }
    }

    /// Checks whether an answer may still come. A stop takes as long as the programs take, but a [`Command::List`] is
    /// answered at once.
    fn look(&self, command: Command, began: Instant) -> Result<(), NoAnswer> {
        // A process that is stopped by a signal or a debugger cannot answer.
        let stat = Pid::from_raw(self.process.cast_signed()).and_then(ProcessStat::of);
        if stat.is_some_and(|stat| stat.is_stopped || stat.is_traced) {
            return Err(NoAnswer::Stopped);
        }
        match (began.elapsed() >= PATIENCE, command) {
            (false, _) => Ok(()),
            (true, Command::List) => Err(NoAnswer::Silent),
            (true, _) => match self.ask(&Request::new(Command::List, Vec::new())) {
                Err(error @ (NoAnswer::Silent | NoAnswer::Stopped)) => Err(error),
                // If the run has ended, so has the connection that waits for the answer.
                _ => Ok(()),
            },
        }
    }
}
