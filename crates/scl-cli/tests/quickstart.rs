//! The first thing that anybody sees: the quick start builds, talks and stops; its file alone, when damaged and mended,
//! is noticed by cargo. All of it without protoc.

use crate::system::{BuildFolder, ChildGuard, SpawnGuarded, System};
#[cfg(feature = "record")]
use scl_tests::HANG_LIMIT;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
#[cfg(feature = "record")]
use std::time::Instant;

#[test]
fn the_quick_start_builds_talks_stops_and_notices_its_file() {
    let quickstart = Copied::new();
    quickstart.talks_and_stops();
    quickstart.names_the_missing_peer();

    quickstart.edit("topology.yaml", "controller.sensor]", "controler.sensor]");
    let broken = quickstart.build();
    let errors = String::from_utf8_lossy(&broken.stderr);
    assert!(!broken.status.success());
    assert!(errors.contains("[SCL0501] unknown component `controler`"), "{errors}");
    assert!(errors.contains("help: did you mean `controller`?"), "{errors}");

    quickstart.edit("topology.yaml", "controler.sensor]", "controller.sensor]");
    let mended = quickstart.build();
    assert!(mended.status.success(), "{}", String::from_utf8_lossy(&mended.stderr));

    quickstart.edit("rover.proto", "double speed = 1;", "double speed = 1");
    let broken = quickstart.build();
    let errors = String::from_utf8_lossy(&broken.stderr);
    assert!(!broken.status.success() && errors.contains("SCL0406") && errors.contains("rover.proto:"), "{errors}");
}

/// The worked example of docs/record.md: the controller against a recorded flight.
#[cfg(feature = "record")]
#[test]
fn a_replayed_recording_gives_the_same_set_points() {
    let quickstart = Copied::new();
    // So that the set-points depend on the measurements alone: on a busy machine, the newest one would replace others,
    // and which of a command and a measurement of the same moment comes first, only the controller could tell.
    quickstart.edit("topology.yaml", "queue: 1}", "queue: 1000}");
    quickstart.edit("src/bin/user_interface.rs", "[0.5, 1.5]", "[1.0, 1.0]");
    let built = quickstart.build();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));

    let mut programs = vec![quickstart.start("actuator"), quickstart.start("controller")];
    let mut recorder = quickstart.record("flight.mcap");
    programs.push(quickstart.start("sensor"));
    let mut user_interface = quickstart.start("user_interface");
    for _ in 0..3 {
        user_interface.wait_for_line("event: ");
    }
    recorder.stop();
    programs.push(user_interface);
    drop(programs);

    let (_actuator, _controller) = (quickstart.start("actuator"), quickstart.start("controller"));
    let mut recorder = quickstart.record("new.mcap");
    let replay = quickstart.scl(&["replay", "flight.mcap", "--as", "sensor,user_interface"]).output().unwrap();
    assert!(replay.status.success(), "{}", String::from_utf8_lossy(&replay.stderr));
    recorder.stop();

    let arguments = ["compare", "flight.mcap", "new.mcap", "--gate", "controller.actuator", "--within", "1e-6"];
    let compared = quickstart.scl(&[&arguments[..], &["--format", "json"]].concat()).output().unwrap();
    let report: serde_json::Value = serde_json::from_slice(&compared.stdout).unwrap();
    let count = |key: &str| report["gates"][0][key].as_u64().unwrap();
    // The recorder may find the sensor after its first measurements, and end before the last set-point.
    assert!(count("paired") > 10 && count("different") == 0, "{report}");
}

/// A running program; killed when dropped.
#[cfg(feature = "record")]
struct Running {
    process: ChildGuard,
    lines: std::io::BufReader<Box<dyn std::io::Read>>,
}

#[cfg(feature = "record")]
impl Running {
    #[track_caller]
    fn wait_for_line(&mut self, part: &str) {
        let started = Instant::now();
        let mut line = String::new();
        while !line.contains(part) {
            line.clear();
            assert!(started.elapsed() < HANG_LIMIT, "no line with `{part}`");
            assert_ne!(std::io::BufRead::read_line(&mut self.lines, &mut line).unwrap(), 0, "no line with `{part}`");
        }
    }

    #[track_caller]
    fn stop(&mut self) {
        crate::system::kill("-INT", self.process.id());
        assert!(self.process.wait().unwrap().success());
    }
}

/// The quick start as a package of its own, in a folder where `protoc` is a trap.
struct Copied {
    system: System,
    build_folder: BuildFolder,
}

impl Copied {
    fn new() -> Self {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
        // First, so that the files are newer than what another test has built: cargo takes all copies for one package.
        let build_folder = BuildFolder::lock();
        let system = System::of_files(&[("bin/protoc", "#!/bin/sh\nexit 1\n")]);
        std::fs::set_permissions(system.path("bin/protoc"), PermissionsExt::from_mode(0o755)).unwrap();
        let source = workspace.join("examples/quickstart");
        for name in ["topology.yaml", "rover.proto"] {
            system.write(name, &std::fs::read_to_string(source.join(name)).unwrap());
        }
        for program in std::fs::read_dir(source.join("src/bin")).unwrap() {
            let program = program.unwrap();
            let name = format!("src/bin/{}", program.file_name().display());
            system.write(&name, &std::fs::read_to_string(program.path()).unwrap());
        }
        system.write("Cargo.lock", &std::fs::read_to_string(workspace.join("Cargo.lock")).unwrap());
        system.write("Cargo.toml", &manifest(workspace));
        Self { system, build_folder }
    }

    fn edit(&self, name: &str, from: &str, to: &str) {
        let text = std::fs::read_to_string(self.system.path(name)).unwrap();
        assert!(text.contains(from), "{text}");
        self.system.write(name, &text.replace(from, to));
    }

    fn talks_and_stops(&self) {
        let mut run = self.system.start_with(&[], |command| self.without_protoc(command));
        for line in
            ["sensor         | speed ", "actuator       | throttle ", "user_interface | asked for 0.5 m/s: accepted"]
        {
            run.wait_for(line);
        }
        run.wait_for("user_interface | event: target is now 0.5 m/s");
        run.wait_for_error("scl: all components are ready after ");
        // One program is replaced, and finds the others, which keep running.
        let mut restart = self.system.scl(&["restart", "user_interface"]);
        self.without_protoc(&mut restart);
        let restarted = restart.output().unwrap();
        let out = String::from_utf8_lossy(&restarted.stdout).into_owned();
        assert!(out.starts_with("user_interface  running as process "), "{out}{restarted:?}");
        run.wait_for("user_interface | asked for 0.5 m/s: accepted");
        run.signal("-INT");
        let (status, _, err) = run.finish();
        assert_eq!(status.code(), Some(0), "{err}");
        for name in ["sensor", "actuator", "controller", "user_interface"] {
            assert!(err.contains(&format!("{name:14}  ended with exit code 0 after ")), "{err}");
        }
    }

    /// The sensor alone: it never gets ready, and says why.
    fn names_the_missing_peer(&self) {
        let sensor = self.build_folder.path().join("debug/sensor");
        let entry = format!("components: {{sensor: {{command: [{sensor:?}], ready_within: 10s}}}}\n");
        self.system.write("launch.yaml", &entry);
        let mut command = self.system.scl(&["run"]);
        self.without_protoc(&mut command);
        let output = command.output().unwrap();
        let err = String::from_utf8_lossy(&output.stderr);
        assert!(err.contains("sensor  not ready within 10s: waiting for `controller.sensor`\n"), "{err}");
        assert_eq!(output.status.code(), Some(1), "{err}");
        std::fs::remove_file(self.system.path("launch.yaml")).unwrap();
    }

    fn build(&self) -> Output {
        let mut command = Command::new(env!("CARGO"));
        command.args(["build", "--bins"]).current_dir(self.system.path("")).stdin(Stdio::null());
        self.without_protoc(&mut command);
        command.output().unwrap()
    }

    /// A program of the quick start, whose standard output is read.
    #[cfg(feature = "record")]
    fn start(&self, name: &str) -> Running {
        let mut command = Command::new(self.build_folder.path().join("debug").join(name));
        self.without_protoc(&mut command);
        let mut process = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn_guarded();
        let output: Box<dyn std::io::Read> = Box::new(process.stdout.take().unwrap());
        Running { process, lines: std::io::BufReader::new(output) }
    }

    /// A recorder that is connected to the gates of the controller.
    #[cfg(feature = "record")]
    fn record(&self, file: &str) -> Running {
        // A recorder that finds the system without the controller connects to it, too, but says so otherwise.
        let info = ["info", "controller", "--system", "rover", "--format", "json"];
        let running = r#""state": "running""#;
        while !String::from_utf8_lossy(&self.scl(&info).output().unwrap().stdout).contains(running) {}
        let mut command = self.scl(&["record", "-o", file, "--system", "rover"]);
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn_guarded();
        let log: Box<dyn std::io::Read> = Box::new(process.stderr.take().unwrap());
        let mut recorder = Running { process, lines: std::io::BufReader::new(log) };
        recorder.wait_for_line("connected to 3 gates");
        recorder
    }

    #[cfg(feature = "record")]
    fn scl(&self, arguments: &[&str]) -> Command {
        let mut command = self.system.scl(arguments);
        self.without_protoc(&mut command);
        command
    }

    fn without_protoc(&self, command: &mut Command) {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let trapped = std::env::join_paths([self.system.path("bin")].into_iter().chain(std::env::split_paths(&path)));
        command
            .env("PATH", trapped.unwrap())
            .env("PROTOC", "/nowhere/protoc")
            .env("CARGO_TARGET_DIR", self.build_folder.path());
        command.env("SCL_RUNTIME_DIR", self.system.path("run"));
    }
}

fn manifest(workspace: &Path) -> String {
    let scl = workspace.join("scl");
    format!(
        "[package]\nname = \"quickstart-copy\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         scl = {{ package = \"scl-gates\", path = {scl:?} }}\ntokio = {{ version = \"1\", features = [\"macros\"] }}\n"
    )
}
