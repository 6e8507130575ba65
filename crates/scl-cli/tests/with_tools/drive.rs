//! `examples/drive`: a wheel is killed, and replaced by one in each other language; what the wheels do is recorded, and
//! the chassis drives by the recording.

use crate::system::{BuildFolder, SpawnGuarded, Started, System};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::process::Stdio;

const STATES: [&str; 4] = ["front_left.state", "front_right.state", "rear_left.state", "rear_right.state"];

#[test]
fn a_wheel_is_replaced_in_each_language_recorded_and_replayed() {
    let _build_folder = BuildFolder::lock();
    let system = System::of_files(&[]);
    let mut others = run(&system, &["--without", "front_right"]);
    others.wait_for_error(": cargo build -p drive --bin wheel --bin chassis --bin logger\n");
    for (profile, language) in [("", "Rust"), ("c", "C"), ("cpp", "C++"), ("python", "Python")] {
        let profile = if profile.is_empty() { vec![] } else { vec!["--profile", profile] };
        let wheel = run(&system, &[&["--only", "front_right"][..], &profile].concat());
        // From two programs, so in either order.
        let missing = RefCell::new(vec![format!("front_right: runs in {language}"), drives_with(language)]);
        others.wait_until(language, |line| {
            missing.borrow_mut().retain(|text| line.strip_prefix("logger     | ") != Some(text));
            missing.borrow().is_empty()
        });
        if language == "Python" {
            record(&system);
        }
        wheel.signal("-KILL");
        assert!(!wheel.finish().0.success());
        others.wait_for("logger     | chassis: stops: a wheel does not report");
    }
    stop(others);

    let mut chassis = run(&system, &["--only", "chassis,logger"]);
    let mut replay =
        system.scl(&["replay", "drive.mcap", "--loop", "--as", "front_left,front_right,rear_left,rear_right"]);
    let replay = replay.stdout(Stdio::null()).spawn_guarded();
    chassis.wait_for_line(&format!("logger  | {}", drives_with("Python")));
    drop(replay);
    stop(chassis);
}

#[test]
fn the_speed_is_set_while_it_drives_and_kept_over_a_restart() {
    let _build_folder = BuildFolder::lock();
    let system = System::of_files(&[]);
    let run = run(&system, &["--only", "chassis,logger", "--set", "chassis.speed=0.5"]);
    let scl = |arguments: &[&str]| {
        let output = system.scl(arguments).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let done = |text: &str| (Some(0), text.to_owned(), String::new());
    let wait_for_speed = |speed: &str| {
        scl_tests::wait_for(speed, || (scl(&["get", "chassis.speed"]) == done(speed)).then_some(()));
    };
    wait_for_speed("0.5\n");
    assert_eq!(scl(&["set", "chassis.speed=2"]), done("chassis.speed: 0.5 -> 2\n"));
    let (code, _, told) = scl(&["set", "chassis.speed=9"]);
    assert_eq!(code, Some(2));
    assert!(told.starts_with("error: wrong value of `chassis.speed`: `9` is not from 0 to 5\n"), "{told}");
    let (code, _, told) = scl(&["restart", "chassis", "--no-build"]);
    assert_eq!(code, Some(0), "{told}");
    wait_for_speed("2\n");
    stop(run);
}

/// What `docs/larger-systems.md` and the readme say of the file.
#[test]
fn the_topology_is_as_long_as_its_readme_says() {
    let read = |name: &str| std::fs::read_to_string(example().join(name)).unwrap();
    let lines = read("topology.yaml").lines().count();
    assert!(read("README.md").contains(&format!("in {lines} lines of [topology.yaml]")), "{lines} lines");
    let page = std::fs::read_to_string(example().join("../../docs/larger-systems.md")).unwrap();
    let topology = example().join("topology.yaml");
    let output = System::of_files(&[]).scl(&["check", topology.to_str().unwrap()]).output().unwrap();
    let counts = String::from_utf8(output.stderr).unwrap();
    let counts = counts.trim().rsplit_once(": ").unwrap().1;
    assert!(page.contains(counts), "{counts}");
}

fn run(system: &System, arguments: &[&str]) -> Started {
    system.start(&[&[example().to_str().unwrap(), "--grace", "1h"], arguments].concat())
}

/// What the chassis logs when it drives with three wheels in Rust and one in this language.
fn drives_with(language: &str) -> String {
    format!("chassis: drives: front_left in Rust, front_right in {language}, rear_left in Rust, rear_right in Rust")
}

fn record(system: &System) {
    let output = system.scl(&[&["record", "-o", "drive.mcap", "--for", "1s"][..], &STATES].concat()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn stop(run: Started) {
    run.signal("-INT");
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
}

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().join("examples/drive")
}
