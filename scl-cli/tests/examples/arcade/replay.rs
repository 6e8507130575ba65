//! A recorded flight played to an autopilot, and its set-points compared with the recorded ones.

use super::flight::{aircraft_folder, command, spawn_recorder};
use super::recording::Recording;
use crate::built;
use crate::system::kill;
use scl_tests::wait_until;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// On a busy machine a replay falls behind, and its next messages come at once: more than fit into the queue of 16 readings. Such a replay is
/// repeated, because the set-points of other readings cannot be compared.
const ATTEMPTS: usize = 5;

/// The autopilot gives the same set-points as in the flight of this name. `arguments` of `scl run` choose the autopilot.
#[track_caller]
pub(super) fn check(name: &str, arguments: &[&str]) {
    let flight = built("arcade").join(name).with_extension("mcap");
    let again = built("arcade").join(format!("{name}-again.mcap"));
    let flown = Recording::read(&flight).motors;
    let is_complete = (0..ATTEMPTS).any(|_| {
        replay(&flight, &again, arguments);
        let replayed = Recording::read(&again).motors;
        println!("{name}: {} set-points, {} in the replay", flown.len(), replayed.len());
        replayed == flown
    });
    assert!(is_complete, "no replay was complete");
    let [flight, again] = [&flight, &again].map(|file| file.to_str().unwrap());
    let compare = ["compare", flight, again, "--gate", "autopilot.motors", "--within", "1e-6"];
    let compared = succeed(&mut command(&aircraft_folder(), &compare));
    println!("{name}: {}", String::from_utf8_lossy(&compared.stdout).trim_end());
}

fn replay(flight: &Path, again: &Path, arguments: &[&str]) {
    let system = aircraft_folder();
    let scl = |arguments: &[&str]| command(&system, arguments);
    let mut autopilot = scl(&[&["run", ".", "--only", "autopilot"], arguments].concat());
    let mut autopilot = autopilot.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let info = ["info", "autopilot", "--system", "arcade"];
    wait_until("the autopilot runs", || scl(&info).output().unwrap().status.success());
    let record = ["record", "autopilot.motors", "--system", "arcade", "--overwrite", "-o", again.to_str().unwrap()];
    let mut recorder = spawn_recorder(&mut scl(&record), "connected to 1 gate");
    // All other components are played. It begins when the autopilot is connected.
    succeed(&mut scl(&["replay", flight.to_str().unwrap(), "--ready", "120s"]));
    for process in [&mut recorder, &mut autopilot] {
        kill("-INT", process.id());
        process.wait().unwrap();
    }
}

#[track_caller]
fn succeed(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success(), "{command:?}\n{out}\n{err}");
    output
}
