//! A flight of `examples/arcade` in real time: `scl run` flies, `scl record` records, `scl echo` tells that it flies.

use super::recording::Recording;
use crate::processes::{BUILD_LIMIT, HANG_LIMIT, command, folder_of, send_lines, spawn_recorder};
use crate::system::{ChildGuard, SpawnGuarded, System, kill};
use crate::{built, example};
use serde_json::Value;
use std::fmt::Write as _;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

const SYSTEM: &str = "arcade";

/// No mission takes longer, in seconds of the vehicle's clock.
const LONGEST_FLIGHT: f64 = 240.0;

/// A running system with its recorder. Dropping it ends all processes.
pub(super) struct Flight {
    others: Vec<ChildGuard>,
    run: ChildGuard,
    recorder: ChildGuard,
    system: System,
    file: PathBuf,
    events: Receiver<Event>,
    /// What `scl run` has printed.
    pub(super) log: String,
}

/// What a test waits for.
pub(super) enum Event {
    /// A line of `scl run`, on standard output or standard error.
    Line(String),
    /// The autopilot flies, at this time of the vehicle's clock, in seconds.
    Flies(f64),
}

/// A flight that is over.
pub(super) struct Flown {
    pub(super) recording: Recording,
    /// All that `scl run` has printed.
    pub(super) log: String,
    /// The exit code of `scl run`.
    pub(super) code: Option<i32>,
}

impl Flight {
    /// Builds and starts the aircraft with more arguments of `scl run`, and waits until all components are ready. The
    /// recording gets this name.
    pub(super) fn start(name: &str, arguments: &[&str]) -> Self {
        let system = folder_of(SYSTEM);
        std::fs::create_dir_all(built("arcade")).unwrap();
        let file = built("arcade").join(name).with_extension("mcap");
        let (sender, events) = channel();
        // It begins first, so that no message is missing.
        let record = ["record", "--system", "arcade", "--overwrite", "--format", "json", "-o", file.to_str().unwrap()];
        let recorder = spawn_recorder(SYSTEM, &mut command(SYSTEM, &system, &record));
        let folder = example("arcade");
        let arguments = [&["run", folder.to_str().unwrap()], arguments].concat();
        let mut run =
            command(SYSTEM, &system, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn_guarded();
        send_lines(run.stdout.take().unwrap(), &sender, Event::Line);
        send_lines(run.stderr.take().unwrap(), &sender, Event::Line);
        let mut flight = Self { others: Vec::new(), run, recorder, system, file, events, log: String::new() };
        let is_ready =
            |event: &Event| matches!(event, Event::Line(line) if line.contains("scl: all components are ready"));
        while !is_ready(&flight.next_within(BUILD_LIMIT)) {}
        let echo = ["echo", "autopilot.flight", "--system", "arcade", "--format", "json"];
        let mut echo = flight.command(&echo).stdout(Stdio::piped()).stderr(Stdio::null()).spawn_guarded();
        send_lines(echo.stdout.take().unwrap(), &sender, |line| Event::Flies(time_of(&line)));
        flight.others.push(echo);
        flight
    }

    /// Starts a program that runs beside the flight.
    pub(super) fn start_beside(&mut self, mut program: Command) {
        self.others.push(program.stdin(Stdio::null()).spawn_guarded());
    }

    /// `scl`, looking at this system.
    pub(super) fn command(&self, arguments: &[&str]) -> Command {
        command(SYSTEM, &self.system, arguments)
    }

    /// What happens next.
    fn next(&mut self) -> Event {
        self.next_within(HANG_LIMIT)
    }

    fn next_within(&mut self, limit: Duration) -> Event {
        let event = self.events.recv_timeout(limit);
        let event = event.unwrap_or_else(|_| panic!("nothing happens any more\n{}", self.log));
        match &event {
            Event::Line(line) => {
                writeln!(self.log, "{line}").unwrap();
                assert!(!line.contains("not restarted:"), "{}", self.log);
            }
            Event::Flies(seconds) => {
                assert!(*seconds < LONGEST_FLIGHT, "still in the air after {seconds} s\n{}", self.log);
            }
        }
        event
    }

    /// Flies until the mission has ended, and returns how: `ended with exit code 0`.
    pub(super) fn fly(&mut self) -> String {
        loop {
            let Event::Line(line) = self.next() else { continue };
            // The lines of its program begin with `uav_mission       | `.
            let words = line.strip_prefix("uav_mission").map(str::trim_start);
            if let Some(ending) = words.filter(|words| words.starts_with("ended with exit code")) {
                return ending.rsplit_once(" after").unwrap().0.to_owned();
            }
        }
    }

    /// Presses Ctrl-C, and reads what was recorded.
    pub(super) fn end(mut self) -> Flown {
        kill("-INT", self.run.id());
        let code = self.run.wait().unwrap().code();
        for other in &mut self.others {
            kill("-INT", other.id());
            other.wait().unwrap();
        }
        // Up to the end of everything that prints.
        for event in &self.events {
            if let Event::Line(line) = event {
                writeln!(self.log, "{line}").unwrap();
            }
        }
        kill("-INT", self.recorder.id());
        let mut report = String::new();
        self.recorder.stdout.take().unwrap().read_to_string(&mut report).unwrap();
        assert!(self.recorder.wait().unwrap().success(), "{report}");
        Flown { recording: Recording::read(&self.file), log: std::mem::take(&mut self.log), code }
    }
}

/// The vehicle's clock in a line of `scl echo autopilot.flight`.
fn time_of(line: &str) -> f64 {
    let echoed: Value = serde_json::from_str(line).unwrap();
    let time_us = match &echoed["message"]["time_us"] {
        Value::String(digits) => digits.parse().unwrap(),
        number => number.as_f64().unwrap(),
    };
    time_us / 1e6
}
