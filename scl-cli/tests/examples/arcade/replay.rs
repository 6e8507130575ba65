//! A recorded flight played to an autopilot, and its set-points compared with the recorded ones.

use super::flight::{aircraft_folder, command, spawn_recorder};
use crate::built;
use crate::system::kill;
use scl_tests::wait_until;
use std::process::{Command, Output, Stdio};

/// The autopilot gives the same set-points as in the flight of this name. `arguments` of `scl run` choose the autopilot.
#[track_caller]
pub(super) fn check(name: &str, arguments: &[&str]) {
    let system = aircraft_folder();
    let flight = built("arcade").join(name).with_extension("mcap");
    let again = built("arcade").join(format!("{name}-again.mcap"));
    let [flight, again] = [&flight, &again].map(|file| file.to_str().unwrap());
    let scl = |arguments: &[&str]| command(&system, arguments);

    let mut autopilot = scl(&[&["run", ".", "--only", "autopilot"], arguments].concat());
    let mut autopilot = autopilot.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_until("the autopilot runs", || {
        scl(&["info", "autopilot", "--system", "arcade"]).output().unwrap().status.success()
    });
    let record = ["record", "autopilot.motors", "--system", "arcade", "--overwrite", "-o", again];
    let mut recorder = spawn_recorder(&mut scl(&record), "connected to 1 gate");
    // All other components are played. It begins when the autopilot is connected.
    succeed(&mut scl(&["replay", flight, "--ready", "120s"]));
    for process in [&mut recorder, &mut autopilot] {
        kill("-INT", process.id());
        process.wait().unwrap();
    }
    let compared = succeed(&mut scl(&["compare", flight, again, "--gate", "autopilot.motors", "--within", "1e-6"]));
    println!("{name}: {}", String::from_utf8_lossy(&compared.stdout).trim_end());
}

#[track_caller]
fn succeed(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success(), "{command:?}\n{out}\n{err}");
    output
}
