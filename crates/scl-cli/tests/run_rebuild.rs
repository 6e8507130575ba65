//! What `scl restart` builds, what a failed build leaves running, and programs that cargo makes.

use crate::system::{FOREVER, Started, System};
use serde_json::Value;
use std::path::PathBuf;
use std::process::Output;

const TOPOLOGY: &str = "\
system: rover
components:
  - name: sensor
  - name: controller
connections: []
";

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn lines(system: &System, file: &str) -> Vec<String> {
    let text = std::fs::read_to_string(system.path(file)).unwrap_or_default();
    text.lines().map(str::to_owned).collect()
}

/// A system whose sensor is built by a script and notes its starts.
fn scripted() -> System {
    let launch = format!(
        "\
build: 'echo all >> built'
environment: {{GIVEN: by the file}}
components:
  sensor: {{build: sh ./make, command: 'echo started; echo x >> starts; {FOREVER}'}}
  controller: {{build: 'echo controller >> built', command: {FOREVER:?}}}
"
    );
    let make = "echo \"$GIVEN, $INHERITED\" >> built; exit 0\n";
    System::of_files(&[("launch.yaml", &launch), ("topology.yaml", TOPOLOGY), ("make", make)])
}

fn start(system: &System, arguments: &[&str]) -> Started {
    let mut run = system.start_with(arguments, |command| {
        command.env("INHERITED", "from the run");
    });
    run.wait_for_line("sensor     | started");
    run
}

fn restart(system: &System, arguments: &[&str]) -> Output {
    system.scl(&[&["restart"], arguments].concat()).env("INHERITED", "from elsewhere").output().unwrap()
}

/// Returns what the run has written to standard error.
fn stop(system: &System, run: Started) -> String {
    assert!(system.scl(&["stop"]).output().unwrap().status.success());
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
    err
}

#[test]
fn a_restart_builds_first_and_a_failed_build_keeps_the_old_process() {
    let system = scripted();
    let mut run = start(&system, &[]);
    system.write("make", "echo 'error[E0308]: mismatched types' >&2; exit 101\n");
    let failed = restart(&system, &["sensor"]);
    let expected = "\
scl: building all components: echo all >> built
scl: building component `sensor`: sh ./make
error[E0308]: mismatched types
error: the build of component `sensor` failed, so nothing was restarted
  = note: `sh ./make` ended with exit code 101

";
    assert_eq!((text(&failed.stderr), failed.status.code()), (expected.to_owned(), Some(1)));
    assert_eq!(lines(&system, "starts").len(), 1, "the old process runs on");
    system.write("make", "echo mended >> built\n");
    let mended = restart(&system, &["sensor"]);
    assert_eq!(mended.status.code(), Some(0), "{}", text(&mended.stderr));
    assert!(text(&mended.stdout).starts_with("sensor  running as process "), "{}", text(&mended.stdout));
    run.wait_for_line("sensor     | started");
    // What belongs to other components is not built.
    assert_eq!(lines(&system, "built"), ["all", "by the file, from the run", "controller", "all", "all", "mended"]);
    stop(&system, run);
}

#[test]
fn a_build_of_a_restart_has_the_environment_of_the_run() {
    let system = scripted();
    let run = start(&system, &[]);
    assert_eq!(restart(&system, &["sensor"]).status.code(), Some(0));
    assert_eq!(lines(&system, "built")[4..], ["by the file, from the run"]);
    stop(&system, run);
}

#[test]
fn nothing_is_built_where_that_is_asked_for() {
    let system = scripted();
    let run = start(&system, &[]);
    assert_eq!(restart(&system, &["sensor", "--no-build"]).status.code(), Some(0));
    assert_eq!(lines(&system, "built").len(), 3);
    stop(&system, run);
    let run = start(&system, &["--no-build"]);
    assert_eq!(restart(&system, &["sensor"]).status.code(), Some(0));
    assert_eq!(lines(&system, "built").len(), 3);
    stop(&system, run);
}

#[test]
fn a_program_that_has_gone_keeps_its_old_process() {
    let system = scripted();
    let launch = "components: {sensor: {build: sh ./make, command: ./program}}";
    system.write("launch.yaml", launch);
    let program = "#!/bin/sh\necho started; exec tail -f /dev/null >/dev/null\n";
    system.write("make", &format!("cat > program <<'END'\n{program}END\nchmod +x program\n"));
    let mut run = system.start(&[]);
    run.wait_for_line("sensor | started");
    system.write("make", "rm program\n");
    let gone = restart(&system, &["sensor"]);
    let err = text(&gone.stderr);
    assert!(err.contains("error: `scl run` refused: the program of component `sensor` does not exist: `"), "{err}");
    assert_eq!(gone.status.code(), Some(2), "{err}");
    assert_eq!(processes(&system).len(), 1);
    stop(&system, run);
}

/// The processes that run the components, by their executables.
fn processes(system: &System) -> Vec<PathBuf> {
    use std::io::{Read, Write};
    let socket = system.run_sockets("rover", "control").remove(0);
    let mut connection = std::os::unix::net::UnixStream::connect(socket).unwrap();
    connection.write_all(b"{\"version\":1,\"command\":\"list\"}\n").unwrap();
    let mut answer = String::new();
    connection.read_to_string(&mut answer).unwrap();
    let answer: Value = serde_json::from_str(&answer).unwrap();
    let components = answer["components"].as_array().unwrap().iter();
    components.filter_map(|it| std::fs::read_link(format!("/proc/{}/exe", it["pid"].as_i64()?)).ok()).collect()
}

/// A program that says a word and runs on.
fn program(word: &str) -> String {
    format!("fn main() {{ println!(\"{word}\"); loop {{ std::thread::park(); }} }}\n")
}

const MANIFEST: &str = "[package]\nname = \"rover\"\nedition = \"2024\"\n[workspace]\n";

fn cargo_system(launch: &str) -> System {
    let files = [
        ("launch.yaml", launch),
        ("topology.yaml", TOPOLOGY),
        ("Cargo.toml", MANIFEST),
        ("src/bin/sensor.rs", &program("one")),
        ("src/bin/controller.rs", &program("two")),
    ];
    System::of_files(&files)
}

fn start_cargo(system: &System, arguments: &[&str], words: &[&str]) -> Started {
    let mut run = system.start_with(arguments, |command| {
        command.env("CARGO_TARGET_DIR", system.path("target")).env_remove("CARGO");
    });
    let mut words = words.to_vec();
    while !words.is_empty() {
        let Some(line) = run.next_line() else { panic!("it ended before {words:?}: {:?}", run.finish()) };
        words.retain(|word| !line.ends_with(word));
    }
    run
}

#[test]
fn cargo_run_becomes_a_build_and_the_program_that_it_makes() {
    let launch = "\
components:
  sensor: {command: [cargo, run, --quiet, --bin, sensor]}
  controller: {command: cargo run --bin controller -- --fast}
";
    let system = cargo_system(launch);
    let run = start_cargo(&system, &[], &["| one", "| two"]);
    let mut running = processes(&system);
    running.sort();
    let debug = system.path("target").canonicalize().unwrap().join("debug");
    assert_eq!(running, [debug.join("controller"), debug.join("sensor")]);

    // A mistake in one program keeps the others from nothing.
    system.write("src/bin/sensor.rs", "fn main() { 1 + }\n");
    let failed = restart(&system, &["sensor"]);
    let err = text(&failed.stderr);
    assert!(err.contains("error: expected expression, found `}`"), "{err}");
    assert!(err.contains("error: the build of component `sensor` failed, so nothing was restarted"), "{err}");
    assert!(err.contains("  = note: `cargo build --bin sensor` ended with exit code 101"), "{err}");
    assert_eq!((failed.status.code(), processes(&system).len()), (Some(1), 2));
    let other = restart(&system, &["controller"]);
    assert_eq!(other.status.code(), Some(0), "{}", text(&other.stderr));
    let err = stop(&system, run);
    assert_eq!(err.matches("scl: building ").count(), 1, "one build for both: {err}");

    // What was built before is started as it is.
    let run = start_cargo(&system, &["--no-build"], &["| one", "| two"]);
    stop(&system, run);
}

#[test]
fn programs_of_one_name_are_told_apart_by_their_package() {
    let package = |name: &str| format!("[package]\nname = \"{name}\"\nedition = \"2024\"\n");
    let launch = "components: {sensor: {command: cargo run -p second --bin sensor}}";
    let files = [
        ("launch.yaml", launch),
        ("topology.yaml", TOPOLOGY),
        ("Cargo.toml", "[workspace]\nmembers = [\"first\", \"second\"]\nresolver = \"3\"\n"),
        ("first/Cargo.toml", &package("first")),
        ("first/src/bin/sensor.rs", &program("first")),
        ("second/Cargo.toml", &package("second")),
        ("second/src/bin/sensor.rs", &program("second")),
    ];
    let system = System::of_files(&files);
    let run = start_cargo(&system, &[], &["sensor | second"]);
    stop(&system, run);
    system.write("launch.yaml", "components: {sensor: {command: cargo run --bin sensor}}");
    let output = system.scl(&["run"]).env("CARGO_TARGET_DIR", system.path("target")).output().unwrap();
    let err = text(&output.stderr);
    assert!(err.contains("error: cargo has built several programs `sensor` for component `sensor`"), "{err}");
    assert!(err.contains("  = help: choose the package with `-p`"), "{err}");
    assert_eq!(output.status.code(), Some(2), "{err}");
}

#[test]
fn the_programs_of_a_package_are_built_again_before_a_restart() {
    let system = cargo_system("");
    std::fs::remove_file(system.path("launch.yaml")).unwrap();
    let mut run = start_cargo(&system, &[], &["sensor     | one", "controller | two"]);
    system.write("src/bin/sensor.rs", &program("three"));
    let output = restart(&system, &["sensor"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    run.wait_for_line("sensor     | three");
    stop(&system, run);
    let run = start_cargo(&system, &["--no-build"], &["sensor     | three", "controller | two"]);
    stop(&system, run);
}
