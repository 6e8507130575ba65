//! A small running system for the tests of the commands that look at one: real processes, real sockets, its own runtime
//! folder.
//!
//! Each component is played by this test program in a process of its own. Every sending gate sends at 50 Hz, every
//! `req` gate calls at 50 Hz, every `rep` gate replies.

mod messages;
mod player;

use crate::system::{ChildGuard, SpawnGuarded, System};
use scl_tests::wait_for;
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The system's topology, with gates of all kinds.
pub(crate) const TOPOLOGY: &str = include_str!("rover.yaml");

/// Its messages.
pub(crate) const MESSAGES: &str = include_str!("rover.proto");

/// The components that run from the start: all but the optional `actuator`.
pub(crate) const COMPONENTS: [&str; 4] = ["sensor", "controller", "logger", "user_interface"];

/// Names the component that a process plays.
const PLAYS: &str = "SCL_TEST_PLAYS";

/// A running system. Dropping it ends its components.
pub(crate) struct Rover {
    playing: Vec<Playing>,
    files: System,
}

struct Playing {
    component: String,
    process: ChildGuard,
}

impl Rover {
    /// Starts the system and waits until all its components are connected.
    pub(crate) fn start() -> Self {
        Self::start_with(&COMPONENTS, |_| {})
    }

    /// Starts some components, in an environment that `prepare` changes, and waits until they are ready.
    pub(crate) fn start_with(components: &[&str], prepare: impl Fn(&mut Command)) -> Self {
        let mut rover = Self::stopped();
        rover.play(components, prepare);
        rover
    }

    /// The files of the system, of which nothing runs.
    pub(crate) fn stopped() -> Self {
        Self::of(TOPOLOGY)
    }

    /// Another topology over the same messages, of which nothing runs.
    pub(crate) fn of(topology: &str) -> Self {
        let files = System::of_files(&[("topology.yaml", topology), ("rover.proto", MESSAGES)]);
        let rover = Self { playing: Vec::new(), files };
        let plan = rover.scl(&["plan"]).output().unwrap();
        assert!(plan.status.success(), "{}", String::from_utf8_lossy(&plan.stderr));
        rover.files.write("plan.json", &String::from_utf8(plan.stdout).unwrap());
        rover
    }

    /// Starts one component and waits until it sends; its peers need not run.
    pub(crate) fn play_alone(&mut self, component: &str) {
        self.play(&[component], |command| {
            command.env(player::ALONE, "1");
        });
    }

    /// Starts components and waits until they are ready, so all their required peers must run.
    pub(crate) fn play(&mut self, components: &[&str], prepare: impl Fn(&mut Command)) {
        let started = components.iter().map(|name| self.spawn(name, &prepare)).collect::<Vec<_>>();
        for mut playing in started {
            playing.wait_until_ready();
            self.playing.push(playing);
        }
    }

    /// Starts components that need not find all their peers.
    pub(crate) fn play_unready(&mut self, components: &[&str]) {
        let started = components.iter().map(|name| self.spawn(name, &|_| {}));
        let started: Vec<_> = started.collect();
        self.playing.extend(started);
    }

    /// Closes a component in order.
    pub(crate) fn stop(&mut self, component: &str) {
        let mut process = self.take(component);
        drop(process.stdin.take());
        assert!(process.wait().unwrap().success(), "{component}");
    }

    /// Kills a component, which leaves its files behind.
    pub(crate) fn kill(&mut self, component: &str) {
        let mut process = self.take(component);
        process.kill().unwrap();
        process.wait().unwrap();
    }

    /// The process of a component.
    pub(crate) fn process_id(&self, component: &str) -> u32 {
        let playing = self.playing.iter().find(|it| it.component == component);
        playing.unwrap_or_else(|| panic!("`{component}` is not running")).process.id()
    }

    /// A file in the system's folder, which is the working folder of [`scl`](Self::scl).
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.files.path(name)
    }

    /// Adds a file to the folder of the system.
    pub(crate) fn write(&self, name: &str, text: &str) {
        self.files.write(name, text);
    }

    /// The runtime folder.
    pub(crate) fn runtime_dir(&self) -> PathBuf {
        self.path("run")
    }

    /// `scl` beside the topology file, looking at this system.
    pub(crate) fn scl(&self, arguments: &[&str]) -> Command {
        let mut command = self.files.scl(arguments);
        self.set_environment(&mut command);
        command
    }

    /// Standard output of an `scl` that succeeds without a word on standard error.
    #[track_caller]
    pub(crate) fn text(&self, arguments: &[&str]) -> String {
        let output = self.scl(arguments).output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Standard error of an `scl` that fails with this exit code and prints nothing else.
    #[track_caller]
    pub(crate) fn error(&self, arguments: &[&str], code: i32) -> String {
        let output = self.scl(arguments).output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stdout), "", "{arguments:?}");
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
        error
    }

    /// The one JSON value that an `scl` prints.
    #[track_caller]
    pub(crate) fn json(&self, arguments: &[&str]) -> Value {
        let text = self.text(arguments);
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{arguments:?}: {error}\n{text}"))
    }

    /// Repeats a query until `found` returns something.
    #[track_caller]
    pub(crate) fn wait_for<T>(&self, arguments: &[&str], found: impl Fn(&Value) -> Option<T>) -> T {
        let arguments = [arguments, &["--format", "json"]].concat();
        wait_for(&arguments.join(" "), || found(&self.json(&arguments)))
    }

    /// As [`Self::text`], for a measurement that has seen messages of every gate. It is repeated until then, because a
    /// sender that gets no processor sends nothing.
    #[track_caller]
    pub(crate) fn measure(&self, arguments: &[&str]) -> String {
        self.measure_with_note(arguments, "")
    }

    /// As [`Self::measure`], with this text on standard error.
    #[track_caller]
    pub(crate) fn measure_with_note(&self, arguments: &[&str], note: &str) -> String {
        wait_for(&arguments.join(" "), || {
            let output = self.scl(arguments).output().unwrap();
            assert_eq!(String::from_utf8_lossy(&output.stderr), note, "{arguments:?}");
            assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}: {output:?}");
            let text = String::from_utf8(output.stdout).unwrap();
            (output.status.success() && !text.contains("no messages")).then_some(text)
        })
    }

    fn spawn(&self, component: &str, prepare: &impl Fn(&mut Command)) -> Playing {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(["--exact", player::TEST, "--nocapture", "--test-threads=1"]);
        command.current_dir(self.path("")).stdin(Stdio::piped()).stdout(Stdio::piped());
        self.set_environment(&mut command);
        let plan = std::fs::read_to_string(self.path("plan.json")).unwrap();
        command.env(PLAYS, component).env(player::PLAN, plan);
        prepare(&mut command);
        Playing { component: component.to_owned(), process: command.spawn_guarded() }
    }

    fn set_environment(&self, command: &mut Command) {
        command.env("SCL_RUNTIME_DIR", self.runtime_dir());
        command.env("XDG_STATE_HOME", self.path("state"));
        for name in ["SCL_SYSTEM", "SCL_TRANSPORT", "SCL_STATS", "SCL_LOG", PLAYS, player::ALONE] {
            command.env_remove(name);
        }
    }

    fn take(&mut self, component: &str) -> ChildGuard {
        let index = self.playing.iter().position(|playing| playing.component == component);
        self.playing.remove(index.unwrap_or_else(|| panic!("`{component}` is not running"))).process
    }
}

impl Playing {
    fn wait_until_ready(&mut self) {
        let lines = BufReader::new(self.process.stdout.as_mut().unwrap()).lines();
        let is_ready = lines.map(Result::unwrap).any(|line| line.ends_with(player::READY));
        assert!(is_ready, "component `{}` is not ready", self.component);
    }
}
