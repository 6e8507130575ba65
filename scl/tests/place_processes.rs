//! What only a second process can show. It is this test program again, told by `SCL_TEST_FOLDER` to be the second.
#![allow(clippy::unwrap_used)]

use std::{
    env,
    io::{BufRead, BufReader},
    os::unix::net::UnixStream,
    path::Path,
    process::{Child, Command, Stdio},
};

use rustix::process::{Resource, Rlimit, setrlimit};
use scl::place::{ComponentLock, Holder, PlaceError, RuntimeDir, SystemDir, bind_ipc, bind_tcp, find};

const ENDPOINT: &str = "sensor.measurements--controller.sensor.1a2b3c4d";
const FOLDER: &str = "SCL_TEST_FOLDER";

#[test]
fn a_second_process_is_told_who_was_first_until_that_one_is_killed() {
    if let Some(folder) = env::var_os(FOLDER) {
        return play_until_killed(&rover(Path::new(&folder)));
    }
    let root = tempfile::tempdir().unwrap();
    let dir = rover(root.path());
    let mut first = second_process("a_second_process_is_told_who_was_first_until_that_one_is_killed", root.path());
    wait_for(&mut first, "playing");

    let error = ComponentLock::take(&dir, "sensor").unwrap_err();
    assert!(matches!(&error, PlaceError::AlreadyRunning { holder: Holder::Process(pid), .. } if *pid == first.id()));
    assert_eq!(
        error.to_string(),
        format!(
            "the component `sensor` is already played by process {}\n\
             help: stop that one first, or start this program in another system with `SCL_SYSTEM`",
            first.id()
        )
    );
    drop(ComponentLock::take(&dir, "controller").unwrap());
    UnixStream::connect(dir.path(ENDPOINT).unwrap()).unwrap();

    first.kill().unwrap();
    first.wait().unwrap();
    assert!(find(&dir, ENDPOINT).is_some(), "a killed program leaves its socket behind");
    let lock = ComponentLock::take(&dir, "sensor").unwrap();
    let bound = bind_ipc(&dir, ENDPOINT).unwrap();
    UnixStream::connect(dir.path(ENDPOINT).unwrap()).unwrap();
    drop(bound);
    lock.clear_leftovers().unwrap();
    assert_eq!(find(&dir, ENDPOINT), None);
}

#[test]
fn the_same_process_is_told_so_and_may_take_the_lock_again_later() {
    let root = tempfile::tempdir().unwrap();
    let dir = rover(root.path());
    let first = ComponentLock::take(&dir, "sensor").unwrap();
    let error = ComponentLock::take(&dir, "sensor").unwrap_err();
    assert!(error.to_string().starts_with("the component `sensor` is already played by this same process"), "{error}");
    drop(first);
    assert!(root.path().join("rover/sensor.lock").exists());
    ComponentLock::take(&dir, "sensor").unwrap();
}

#[test]
fn without_descriptors_every_call_is_a_clear_error() {
    if let Some(folder) = env::var_os(FOLDER) {
        return run_out_of_descriptors(&rover(Path::new(&folder)));
    }
    let root = tempfile::tempdir().unwrap();
    let mut second = second_process("without_descriptors_every_call_is_a_clear_error", root.path());
    assert!(second.wait().unwrap().success());
    assert_eq!(std::fs::read_dir(root.path().join("rover")).unwrap().count(), 0);
}

fn rover(root: &Path) -> SystemDir {
    let runtime = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| root.into())).unwrap();
    runtime.system("rover").unwrap()
}

fn second_process(test: &str, folder: &Path) -> Child {
    Command::new(env::current_exe().unwrap())
        .args(["--exact", test, "--nocapture"])
        .env(FOLDER, folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits for a line of the second process; if it fails, its output ends without one.
fn wait_for(child: &mut Child, word: &str) {
    let lines = BufReader::new(child.stdout.as_mut().unwrap()).lines();
    assert!(lines.map(Result::unwrap).any(|line| line.ends_with(word)), "the second process never said `{word}`");
}

fn play_until_killed(dir: &SystemDir) {
    let _lock = ComponentLock::take(dir, "sensor").unwrap();
    let _bound = bind_ipc(dir, ENDPOINT).unwrap();
    println!("playing");
    // Returns only if the first process ends without killing this one.
    let _ = std::io::stdin().read_line(&mut String::new());
}

fn run_out_of_descriptors(dir: &SystemDir) {
    setrlimit(Resource::Nofile, Rlimit { current: Some(3), maximum: Some(3) }).unwrap();
    let errors = [
        bind_ipc(dir, ENDPOINT).unwrap_err(),
        bind_tcp(dir, ENDPOINT).unwrap_err(),
        ComponentLock::take(dir, "sensor").unwrap_err(),
    ];
    for error in errors {
        assert!(error.to_string().contains("help: no file descriptor is left"), "{error}");
    }
    assert_eq!(find(dir, ENDPOINT), None);
}
