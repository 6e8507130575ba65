//! A system in a folder of its own, and the real `scl run` on it. Nothing here waits for a time, only for events.
#![cfg_attr(not(feature = "run"), allow(dead_code, reason = "the tests of `scl run` use a part of it"))]

mod guard;

pub(crate) use guard::{ChildGuard, SpawnGuarded};
use scl_tests::{HANG_LIMIT, lock_file};
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{ChildStderr, ChildStdout, Command, ExitStatus, Output, Stdio};
use std::time::Instant;

/// A program that never ends by itself. (`tail` would notice the end of a pipe to which it writes.)
pub(crate) const FOREVER: &str = "exec tail -f /dev/null >/dev/null";

/// The folder that the tests themselves were built into, so that little has to be built again, for one test at a time:
/// several build programs called `sensor` there and start them.
pub(crate) struct BuildFolder(#[expect(dead_code, reason = "is held")] File);

impl BuildFolder {
    /// Waits until no other test has it, of this process or another one.
    pub(crate) fn lock() -> Self {
        Self(lock_file(&build_folder_without_programs().join("programs.lock")))
    }

    pub(crate) fn path(&self) -> PathBuf {
        build_folder_without_programs()
    }
}

/// The same folder, for what builds no programs in it.
pub(crate) fn build_folder_without_programs() -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_scl")).ancestors().nth(2).unwrap().to_owned()
}

/// A folder with a system in it.
pub(crate) struct System {
    folder: tempfile::TempDir,
}

impl System {
    /// A system whose launch file gives each component a command for the shell.
    pub(crate) fn of(components: &[(&str, &str)]) -> Self {
        let entries = components.iter().map(|(name, command)| format!("  {name}:\n    command: {command:?}\n"));
        let system = Self { folder: tempfile::tempdir().unwrap() };
        system.write("launch.yaml", &format!("components:\n{}", entries.collect::<String>()));
        system
    }

    /// A system of these files.
    pub(crate) fn of_files(files: &[(&str, &str)]) -> Self {
        let system = Self { folder: tempfile::tempdir().unwrap() };
        files.iter().for_each(|(name, text)| system.write(name, text));
        system
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Adds a file.
    pub(crate) fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    /// Adds a named pipe. A reader gets to its end when every program that has opened it for writing has ended.
    pub(crate) fn make_pipe(&self, name: &str) -> PathBuf {
        let path = self.path(name);
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        path
    }

    /// The sockets of every `scl run` of a system that end with `ending`, `control` or `notify`. Only those that can be
    /// connected to: before that, their names begin with a dot.
    pub(crate) fn run_sockets(&self, name: &str, ending: &str) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(self.path("runtime").join(name)).into_iter().flatten().flatten();
        let is_meant = |name: &str| name.starts_with("run.") && name.ends_with(&format!(".{ending}"));
        entries.filter(|entry| is_meant(&entry.file_name().to_string_lossy())).map(|entry| entry.path()).collect()
    }

    /// `scl` with the folder as its working folder and an environment without wishes for colours.
    pub(crate) fn scl(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_scl"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        // Where `scl run` writes logs.
        command.env("XDG_STATE_HOME", self.path("state"));
        for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE"] {
            command.env_remove(name);
        }
        command.env("SCL_RUNTIME_DIR", self.path("runtime")).env("SCL_STOP_WITHIN", scl_tests::NEVER);
        command
    }

    /// Runs the system to its end.
    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        self.scl(&[&["run"], arguments].concat()).output().unwrap()
    }

    /// Starts the system.
    pub(crate) fn start(&self, arguments: &[&str]) -> Started {
        self.start_with(arguments, |_| {})
    }

    /// Starts the system as a shell does that ignores what asks it to stop.
    pub(crate) fn start_ignoring_signals(&self, arguments: &[&str]) -> Started {
        self.start_by("/bin/sh", &["-c", "trap '' INT TERM HUP; exec \"$0\" \"$@\""], arguments)
    }

    /// Starts the system by a program that becomes the command that it gets as further arguments.
    pub(crate) fn start_by(&self, program: &str, by: &[&str], arguments: &[&str]) -> Started {
        let scl = self.scl(&[]);
        let mut command = Command::new(program);
        command.args(by).arg(scl.get_program()).arg("run").args(arguments);
        command.current_dir(self.folder.path()).stdin(Stdio::null());
        command.env("SCL_RUNTIME_DIR", self.path("runtime"));
        Started::spawn(&mut command)
    }

    /// Starts the system in another environment.
    pub(crate) fn start_with(&self, arguments: &[&str], prepare: impl Fn(&mut Command)) -> Started {
        let mut command = self.scl(&[&["run"], arguments].concat());
        prepare(&mut command);
        Started::spawn(&mut command)
    }
}

/// A running `scl run`.
pub(crate) struct Started {
    process: ChildGuard,
    lines: BufReader<ChildStdout>,
    errors: BufReader<ChildStderr>,
    seen_errors: String,
}

impl Started {
    pub(crate) fn spawn(command: &mut Command) -> Self {
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn_guarded();
        let lines = BufReader::new(process.stdout.take().unwrap());
        let errors = BufReader::new(process.stderr.take().unwrap());
        Self { process, lines, errors, seen_errors: String::new() }
    }

    /// Reads standard output up to this line.
    pub(crate) fn wait_for_line(&mut self, expected: &str) {
        self.wait_until(expected, |line| line == expected);
    }

    /// Reads standard error up to a line that contains this.
    pub(crate) fn wait_for_error(&mut self, expected: &str) {
        let started = Instant::now();
        loop {
            let seen = self.seen_errors.len();
            self.errors.read_line(&mut self.seen_errors).unwrap();
            let line = &self.seen_errors[seen..];
            let is_missing = line.is_empty() || started.elapsed() > HANG_LIMIT;
            assert!(!is_missing, "no `{expected}` in:\n{}", self.seen_errors);
            if line.contains(expected) {
                return;
            }
        }
    }

    /// Reads standard output up to a line that starts like this.
    pub(crate) fn wait_for(&mut self, start: &str) {
        self.wait_until(start, |line| line.starts_with(start));
    }

    /// The next line of standard output; `None` at its end.
    pub(crate) fn next_line(&mut self) -> Option<String> {
        let mut line = String::new();
        (self.lines.read_line(&mut line).unwrap() > 0).then(|| line.trim_end().to_owned())
    }

    /// Reads standard output up to a line for which `found` returns true.
    pub(crate) fn wait_until(&mut self, expected: &str, found: impl Fn(&str) -> bool) {
        let started = Instant::now();
        let mut seen = Vec::new();
        loop {
            let line = self.next_line().filter(|_| started.elapsed() < HANG_LIMIT);
            let line = line.unwrap_or_else(|| panic!("no line `{expected}` in:\n{}", seen.join("\n")));
            if found(&line) {
                return;
            }
            seen.push(line);
        }
    }

    /// Writes to its standard input, which is a pipe.
    pub(crate) fn write_input(&mut self, text: &str) {
        self.process.stdin.as_mut().unwrap().write_all(text.as_bytes()).unwrap();
    }

    pub(crate) fn process_id(&self) -> u32 {
        self.process.id()
    }

    /// Sends a signal, for example `-INT`, to the runner alone.
    pub(crate) fn signal(&self, signal: &str) {
        kill(signal, self.process_id());
    }

    pub(crate) fn is_running(&mut self) -> bool {
        self.process.try_wait().unwrap().is_none()
    }

    /// Waits for the end without reading another byte.
    pub(crate) fn wait_unread(mut self) -> ExitStatus {
        self.process.wait().unwrap()
    }

    /// Waits for the end; gives the rest of standard output, and all of standard error.
    pub(crate) fn finish(mut self) -> (ExitStatus, String, String) {
        let mut out = String::new();
        self.lines.read_to_string(&mut out).unwrap();
        self.errors.read_to_string(&mut self.seen_errors).unwrap();
        (self.process.wait().unwrap(), out, self.seen_errors)
    }
}

/// Sends a signal to a process.
pub(crate) fn kill(signal: &str, process: u32) {
    assert!(Command::new("kill").arg(signal).arg(process.to_string()).status().unwrap().success());
}

/// Waits until every program that writes to this pipe has ended.
pub(crate) fn wait_for_writers_to_end(pipe: &Path) -> String {
    let mut text = String::new();
    File::open(pipe).unwrap().read_to_string(&mut text).unwrap();
    text
}

/// What a program wrote, with the times in it made equal: `after 0.1 s` becomes `after N s`.
pub(crate) fn without_times(text: impl AsRef<[u8]>) -> String {
    let text = String::from_utf8(text.as_ref().to_vec()).unwrap();
    let line = |line: &str| match line.rsplit_once(" after ") {
        Some((before, _)) => format!("{before} after N s\n"),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}
