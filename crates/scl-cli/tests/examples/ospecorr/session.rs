//! A session of `examples/ospecorr` as real processes: `scl run` runs it, `scl record` writes it down, `scl echo` tells
//! the time.

use super::recording::Recording;
use crate::processes::{BUILD_LIMIT, HANG_LIMIT, command, folder_of, send_lines, spawn_recorder};
use crate::system::{ChildGuard, SpawnGuarded, System, kill};
use crate::{built, example};
use serde_json::Value;
use std::fmt::Write as _;
use std::io::Read;
use std::path::PathBuf;
use std::process::Stdio;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

const SYSTEM: &str = "ospecorr";

/// A running system with its recorder. Dropping it ends all processes.
pub(super) struct Session {
    echo: Option<ChildGuard>,
    run: ChildGuard,
    recorder: ChildGuard,
    system: System,
    file: PathBuf,
    events: Receiver<Event>,
    /// The newest time of the band.
    time_us: u64,
    /// What `scl run` has printed.
    log: String,
}

enum Event {
    /// A line of `scl run`, on standard output or standard error.
    Line(String),
    /// The time of the band.
    Time(u64),
}

impl Session {
    /// Builds and starts the radio, and waits until all components are ready. The recording gets this name.
    pub(super) fn start(name: &str) -> Self {
        let system = folder_of(SYSTEM);
        std::fs::create_dir_all(built("ospecorr")).unwrap();
        let file = built("ospecorr").join(name).with_extension("mcap");
        let (sender, events) = channel();
        // The recorder begins first, so that no message is missing.
        let record = ["record", "--system", "ospecorr", "--overwrite", "-o", file.to_str().unwrap()];
        let recorder = spawn_recorder(SYSTEM, &mut command(SYSTEM, &system, &record));
        let folder = example("ospecorr");
        let arguments = ["run", folder.to_str().unwrap(), "--profile", "visits"];
        let mut run =
            command(SYSTEM, &system, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn_guarded();
        send_lines(run.stdout.take().unwrap(), &sender, Event::Line);
        send_lines(run.stderr.take().unwrap(), &sender, Event::Line);
        let mut session = Self { echo: None, run, recorder, system, file, events, time_us: 0, log: String::new() };
        while !session.log.contains("scl: all components are ready") {
            session.next(BUILD_LIMIT);
        }
        let echo = ["echo", "spectrum.truth", "--system", "ospecorr", "--format", "json"];
        let mut echo =
            command(SYSTEM, &session.system, &echo).stdout(Stdio::piped()).stderr(Stdio::null()).spawn_guarded();
        send_lines(echo.stdout.take().unwrap(), &sender, |line| Event::Time(time_of(&line)));
        session.echo = Some(echo);
        session
    }

    /// Waits until this time of the band, in seconds.
    pub(super) fn run_until(&mut self, seconds: f64) {
        while (self.time_us as f64) < seconds * 1e6 {
            self.next(HANG_LIMIT);
        }
    }

    /// What happens next.
    fn next(&mut self, limit: Duration) {
        let event = self.events.recv_timeout(limit);
        match event.unwrap_or_else(|_| panic!("nothing happens any more\n{}", self.log)) {
            Event::Time(time_us) => self.time_us = time_us,
            Event::Line(line) => {
                writeln!(self.log, "{line}").unwrap();
                assert!(!line.contains("not restarted:"), "{}", self.log);
            }
        }
    }

    /// Presses Ctrl-C, and returns what was recorded, and what `scl run` has printed.
    pub(super) fn end(mut self) -> (Recording, String) {
        kill("-INT", self.run.id());
        let status = self.run.wait().unwrap();
        let mut echo = self.echo.take().unwrap();
        kill("-INT", echo.id());
        echo.wait().unwrap();
        // Up to the end of everything that prints.
        while let Ok(event) = self.events.recv() {
            if let Event::Line(line) = event {
                writeln!(self.log, "{line}").unwrap();
            }
        }
        assert!(status.success(), "{status}\n{}", self.log);
        kill("-INT", self.recorder.id());
        let mut report = String::new();
        self.recorder.stdout.take().unwrap().read_to_string(&mut report).unwrap();
        assert!(self.recorder.wait().unwrap().success(), "{report}");
        (Recording::read(&self.file), std::mem::take(&mut self.log))
    }
}

/// The time in a line of `scl echo`.
fn time_of(line: &str) -> u64 {
    let echoed: Value = serde_json::from_str(line).unwrap();
    match &echoed["message"]["time_us"] {
        Value::String(digits) => digits.parse().unwrap(),
        number => number.as_u64().unwrap(),
    }
}
