//! A recorded flight played to an autopilot, and its set-points compared with the recorded ones.

use super::flight::{aircraft_folder, command, spawn_recorder};
use super::recording::Recording;
use crate::built;
use crate::system::{SpawnGuarded, kill};
use scl_tests::wait_until;
use std::path::Path;
use std::process::Stdio;

/// On a busy machine a replay falls behind. Its next messages then come at once: later than the autopilot expects them,
/// or more than fit into its queue of 16 readings. Such a replay says nothing, so there are several; an autopilot that
/// computes something else differs in all of them.
const ATTEMPTS: usize = 4;

/// The autopilot gives the same set-points as in the flight of this name.
#[track_caller]
pub(super) fn check(name: &str) {
    let flight = built("arcade").join(name).with_extension("mcap");
    let again = built("arcade").join(format!("{name}-again.mcap"));
    let is_equal = (0..ATTEMPTS).any(|_| {
        replay(&flight, &again);
        compare(name, &flight, &again)
    });
    assert!(is_equal, "the set-points of `{name}` are different in each of {ATTEMPTS} replays");
}

fn compare(name: &str, flight: &Path, again: &Path) -> bool {
    let [flown, replayed] = [flight, again].map(|file| Recording::read(file).motors);
    println!("{name}: {} set-points, {} in the replay", flown.len(), replayed.len());
    if flown != replayed {
        return false;
    }
    let [flight, again] = [flight, again].map(|file| file.to_str().unwrap());
    let compare = ["compare", flight, again, "--gate", "autopilot.motors", "--within", "1e-6"];
    let output = command(&aircraft_folder(), &compare).output().unwrap();
    println!("{}", String::from_utf8_lossy(&output.stdout));
    output.status.success()
}

fn replay(flight: &Path, again: &Path) {
    let system = aircraft_folder();
    let scl = |arguments: &[&str]| command(&system, arguments);
    let mut autopilot = scl(&["run", ".", "--only", "autopilot"]);
    let mut autopilot = autopilot.stdout(Stdio::null()).stderr(Stdio::null()).spawn_guarded();
    let info = ["info", "autopilot", "--system", "arcade"];
    wait_until("the autopilot runs", || scl(&info).output().unwrap().status.success());
    let record = ["record", "autopilot.motors", "--system", "arcade", "--overwrite", "-o", again.to_str().unwrap()];
    let mut recorder = spawn_recorder(&mut scl(&record), "connected to 1 gate");
    // All other components are played. It begins when the autopilot is connected.
    let replay = scl(&["replay", flight.to_str().unwrap(), "--ready", "120s"]).output().unwrap();
    assert!(replay.status.success(), "{}", String::from_utf8_lossy(&replay.stderr));
    for process in [&mut recorder, &mut autopilot] {
        kill("-INT", process.id());
        process.wait().unwrap();
    }
}
