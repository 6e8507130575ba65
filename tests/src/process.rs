//! A program under test: told what to do through its input, watched through its output.

use rustix::process::{Pid, Signal};
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::Duration;

/// When a line has not come by then, it never will: the test fails instead of hanging.
pub const HANGS: Duration = Duration::from_secs(60);

/// A running program; killed when dropped.
pub struct Process {
    name: String,
    child: Child,
    input: Option<ChildStdin>,
    lines: Receiver<String>,
}

impl Process {
    /// Starts a program with its output and errors as one stream of lines.
    pub fn start(program: impl AsRef<OsStr>, arguments: &[&str], environment: &[(&str, &OsStr)]) -> Self {
        let mut child = Command::new(&program)
            .args(arguments)
            .envs(environment.iter().copied())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("{} does not start: {error}", program.as_ref().display()));
        let (sender, lines) = mpsc::channel();
        let outputs: [Option<Box<dyn Read + Send>>; 2] =
            [child.stdout.take().map(|out| Box::new(out) as _), child.stderr.take().map(|err| Box::new(err) as _)];
        for output in outputs.into_iter().flatten() {
            let sender = sender.clone();
            thread::spawn(move || {
                for line in BufReader::new(output).lines().map_while(Result::ok) {
                    let _nobody_listens = sender.send(line);
                }
            });
        }
        let name = arguments.join(" ");
        Self { name, input: child.stdin.take(), child, lines }
    }

    /// The process number.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// What `/proc` says of it after its name: state, parent, and so on, as `man 5 proc` counts from 3.
    fn stat(&self) -> Vec<String> {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.id())).expect("a running process");
        let (_name, rest) = stat.rsplit_once(')').expect("a name in brackets");
        rest.split_whitespace().map(str::to_owned).collect()
    }

    /// How often its first thread has gone to sleep by itself, until something happened.
    pub fn sleeps(&self) -> u64 {
        self.status("voluntary_ctxt_switches").parse().expect("a number")
    }

    /// How the operating system schedules it: 0 is the usual way, 1 is first in, first out.
    pub fn policy(&self) -> String {
        self.stat()[38].clone()
    }

    /// Its real-time priority; 0 is none.
    pub fn priority(&self) -> String {
        self.stat()[37].clone()
    }

    /// A line of `/proc/PID/status`, without its name.
    pub fn status(&self, name: &str) -> String {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.id())).expect("a running process");
        let line = status.lines().find_map(|line| line.strip_prefix(name)).expect("a known line");
        line.trim_start_matches(':').trim().to_owned()
    }

    /// How many descriptors it has open.
    pub fn descriptors(&self) -> usize {
        std::fs::read_dir(format!("/proc/{}/fd", self.id())).expect("a running process").count()
    }

    /// Stops it as Ctrl-Z does, and waits until it stands still.
    pub fn stop(&self) {
        self.signal(Signal::STOP);
        while self.stat()[0] != "T" {
            thread::yield_now();
        }
    }

    /// Lets it go on after [`stop`](Self::stop).
    pub fn go_on(&self) {
        self.signal(Signal::CONT);
    }

    fn signal(&self, signal: Signal) {
        let id = Pid::from_raw(self.id().cast_signed()).expect("a process number");
        rustix::process::kill_process(id, signal).expect("a running process");
    }

    /// Tells the program what to do.
    pub fn tell(&mut self, command: &str) {
        let input = self.input.as_mut().expect("the program's input is open");
        writeln!(input, "{command}").unwrap_or_else(|error| panic!("`{}` takes no commands: {error}", self.name));
    }

    /// The next line of output.
    pub fn line(&mut self) -> String {
        match self.lines.recv_timeout(HANGS) {
            Ok(line) => line,
            Err(mpsc::RecvTimeoutError::Timeout) => panic!("`{}` says nothing any more", self.name),
            Err(mpsc::RecvTimeoutError::Disconnected) => panic!("`{}` ended: {:?}", self.name, self.child.wait()),
        }
    }

    /// Asserts what the next line is.
    pub fn says(&mut self, expected: &str) {
        let line = self.line();
        assert_eq!(line, expected, "from `{}`", self.name);
    }

    /// Tells the program something and asserts its answer.
    pub fn does(&mut self, command: &str, expected: &str) {
        self.tell(command);
        self.says(expected);
    }

    /// Reads lines up to one that contains a text, and returns that.
    pub fn says_sometime(&mut self, text: &str) -> String {
        loop {
            let line = self.line();
            if line.contains(text) {
                return line;
            }
        }
    }

    /// Waits for its end; what it said last.
    pub fn ends(mut self) -> (ExitStatus, Vec<String>) {
        drop(self.input.take());
        let mut said = Vec::new();
        while let Ok(line) = self.lines.recv_timeout(HANGS) {
            said.push(line);
        }
        (self.child.wait().expect("an exit status"), said)
    }

    /// Ends it as `kill -9` does, and waits until it is gone.
    pub fn kill(mut self) {
        self.child.kill().expect("killed");
        self.child.wait().expect("gone");
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ended = self.child.kill();
        let _status = self.child.wait();
    }
}
