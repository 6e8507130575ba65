//! A program under test: controlled through its input, observed through its output.

use crate::runtime_folder::RuntimeFolder;
use crate::{HANG_LIMIT, wait_until};
use rustix::process::{Pid, Signal};
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Instant;

/// A running program; killed when dropped.
pub struct Process {
    name: String,
    child: Child,
    input: Option<ChildStdin>,
    output: Lines,
    log: Lines,
    /// The runtime folder: without it, the program would make one that nobody removes.
    _folder: Option<Arc<RuntimeFolder>>,
}

/// How a program ended, and what it printed that no test has read yet.
#[derive(Debug)]
pub struct Exit {
    /// Its exit status.
    pub status: ExitStatus,
    /// The rest of its standard output.
    pub output: Vec<String>,
    /// The rest of its standard error.
    pub log: Vec<String>,
}

impl Process {
    /// Starts a program.
    pub fn start(program: impl AsRef<OsStr>, arguments: &[&str], environment: &[(&str, &OsStr)]) -> Self {
        let mut command = Command::new(&program);
        command.args(arguments).envs(environment.iter().copied());
        Self::spawn(command)
    }

    /// Starts a program that needs more than arguments and environment.
    pub fn spawn(mut command: Command) -> Self {
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap_or_else(|error| panic!("{command:?} does not start: {error}"));
        let arguments: Vec<_> = command.get_args().map(OsStr::to_string_lossy).collect();
        Self {
            name: arguments.join(" "),
            input: child.stdin.take(),
            output: Lines::of(child.stdout.take()),
            log: Lines::of(child.stderr.take()),
            child,
            _folder: None,
        }
    }

    /// Keeps a folder until the program has ended.
    pub(crate) fn keeping(mut self, folder: Arc<RuntimeFolder>) -> Self {
        self._folder = Some(folder);
        self
    }

    /// The process id.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Gives the program a command.
    pub fn tell(&mut self, command: &str) {
        let input = self.input.as_mut().expect("the program's input is open");
        writeln!(input, "{command}").unwrap_or_else(|error| panic!("`{}` takes no commands: {error}", self.name));
    }

    /// The next line of standard output.
    #[track_caller]
    pub fn next_line(&mut self) -> String {
        match self.output.next() {
            Ok(line) => line,
            Err(RecvTimeoutError::Timeout) => {
                panic!("`{}` prints nothing; its log: {:#?}", self.name, self.log.so_far())
            }
            Err(RecvTimeoutError::Disconnected) => {
                let log = self.log.rest().0;
                panic!("`{}` ended: {:?}; its log: {log:#?}", self.name, self.child.wait())
            }
        }
    }

    /// The next line of standard output, if it has been printed already.
    pub fn try_next_line(&mut self) -> Option<String> {
        self.output.0.try_recv().ok()
    }

    /// Asserts what the next line of standard output is.
    #[track_caller]
    pub fn expect(&mut self, expected: &str) {
        let line = self.next_line();
        assert_eq!(line, expected, "from `{}`", self.name);
    }

    /// Gives the program a command and asserts the answer.
    #[track_caller]
    pub fn ask(&mut self, command: &str, expected: &str) {
        self.tell(command);
        let line = self.next_line();
        assert_eq!(line, expected, "from `{}` after `{command}`", self.name);
    }

    /// Has the program wait until its peers are connected.
    #[track_caller]
    pub fn get_ready(&mut self) {
        self.ask("ready 300000", "ready");
    }

    /// Reads standard output up to a line that contains a text, and returns that line.
    #[track_caller]
    pub fn expect_containing(&mut self, text: &str) -> String {
        match self.output.find(text) {
            Ok(line) => line,
            Err(seen) => {
                let (state, log) = (self.child.try_wait(), self.log.so_far());
                panic!("`{}` ({state:?}) does not print `{text}`, but: {seen:#?}; its log: {log:#?}", self.name)
            }
        }
    }

    /// Reads standard error up to a line that contains a text, and returns that line.
    #[track_caller]
    pub fn expect_log(&mut self, text: &str) -> String {
        match self.log.find(text) {
            Ok(line) => line,
            Err(seen) => {
                let state = self.child.try_wait();
                panic!("`{}` ({state:?}) does not log `{text}`, but: {seen:#?}", self.name)
            }
        }
    }

    /// Closes the program's input, at which a program that follows commands ends.
    pub fn close_input(&mut self) {
        drop(self.input.take());
    }

    /// Closes the program's input and waits for its end.
    ///
    /// # Panics
    /// If the program does not end.
    #[track_caller]
    pub fn wait_for_exit(mut self) -> Exit {
        self.close_input();
        let (output, log) = (self.output.rest(), self.log.rest());
        assert!(output.1 && log.1, "`{}` does not end: {:#?}, {:#?}", self.name, output.0, log.0);
        Exit { status: self.child.wait().expect("an exit status"), output: output.0, log: log.0 }
    }

    /// Sends a signal.
    pub fn signal(&self, signal: Signal) {
        let id = Pid::from_raw(self.id().cast_signed()).expect("a process id");
        rustix::process::kill_process(id, signal).expect("a running process");
    }

    /// Stops the program as Ctrl-Z does (SIGSTOP), and waits until it has stopped.
    pub fn pause(&self) {
        self.signal(Signal::STOP);
        self.wait_until_stopped();
    }

    /// Waits until the program has stopped itself.
    pub fn wait_until_stopped(&self) {
        wait_until("the program has stopped", || self.stat()[0] == "T");
    }

    /// Resumes the program after [`pause`](Self::pause).
    pub fn resume(&self) {
        self.signal(Signal::CONT);
    }

    /// Kills the program (SIGKILL) and waits until it is gone.
    pub fn kill(mut self) {
        self.child.kill().expect("killed");
        self.child.wait().expect("gone");
    }

    /// Kills the program and returns what it printed that no test has read yet.
    pub fn kill_and_read(mut self) -> Vec<String> {
        self.child.kill().expect("killed");
        self.output.rest().0
    }

    /// Whether the program is still running.
    pub fn is_running(&mut self) -> bool {
        self.child.try_wait().expect("a status").is_none()
    }

    /// The fields of `/proc/PID/stat` after the name: state, parent, and so on, as `man 5 proc` counts from 3.
    pub(crate) fn stat(&self) -> Vec<String> {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.id())).expect("a running process");
        let (_name, rest) = stat.rsplit_once(')').expect("a name in brackets");
        rest.split_whitespace().map(str::to_owned).collect()
    }
}

impl Exit {
    /// The exit code as a shell shows it: 128 plus the signal's number for a program ended by a signal.
    pub fn code(&self) -> i32 {
        self.status.code().or_else(|| self.status.signal().map(|signal| 128 + signal)).unwrap_or(-1)
    }

    /// Everything it printed that no test has read yet, for texts that may appear in either stream.
    pub fn text(&self) -> String {
        [&self.output[..], &self.log[..]].concat().join("\n")
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ended = self.child.kill();
        let _status = self.child.wait();
    }
}

/// The lines of one output stream, read by a thread so that the program never waits for the test.
struct Lines(Receiver<String>);

impl Lines {
    fn of(stream: Option<impl Read + Send + 'static>) -> Self {
        let (sender, lines) = mpsc::channel();
        if let Some(stream) = stream {
            thread::spawn(move || {
                for line in BufReader::new(stream).lines().map_while(Result::ok) {
                    let _test_has_ended = sender.send(line);
                }
            });
        }
        Self(lines)
    }

    fn next(&self) -> Result<String, RecvTimeoutError> {
        self.0.recv_timeout(HANG_LIMIT)
    }

    /// The next line that contains a text, or else those that came until the end of the stream or the time limit: a
    /// program may print an endless stream of other lines.
    fn find(&self, text: &str) -> Result<String, Vec<String>> {
        let (start, mut seen) = (Instant::now(), Vec::new());
        while start.elapsed() < HANG_LIMIT {
            match self.next() {
                Ok(line) if line.contains(text) => return Ok(line),
                Ok(line) => seen.push(line),
                Err(_) => break,
            }
        }
        Err(seen)
    }

    /// The lines up to the end of the stream, and whether the end has come within the time limit.
    fn rest(&self) -> (Vec<String>, bool) {
        let mut lines = Vec::new();
        loop {
            match self.next() {
                Ok(line) => lines.push(line),
                Err(error) => return (lines, error == RecvTimeoutError::Disconnected),
            }
        }
    }

    fn so_far(&self) -> Vec<String> {
        self.0.try_iter().collect()
    }
}
