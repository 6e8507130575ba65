//! Tests that need a second process: this test program again, with `SCL_TEST_FOLDER` set.
#![allow(clippy::unwrap_used)]

use std::{
    env,
    io::{BufRead, BufReader},
    os::unix::net::UnixStream,
    path::Path,
    process::{Child, Command, Stdio},
};

use rustix::process::{Resource, Rlimit, setrlimit};
use scl::runtime_dir::internals::{ComponentLock, bind_ipc, bind_tcp, find};
use scl::runtime_dir::{ComponentProcess, RuntimeDir, RuntimeDirError, SystemDir};

const ENDPOINT: &str = "sensor.measurements--controller.sensor.1a2b3c4d";
const FOLDER: &str = "SCL_TEST_FOLDER";

#[test]
fn the_lock_names_the_running_process_until_it_is_killed() {
    if let Some(folder) = env::var_os(FOLDER) {
        return run_until_killed(&rover(Path::new(&folder)));
    }
    let root = tempfile::tempdir().unwrap();
    let dir = rover(root.path());
    let mut first = second_process("the_lock_names_the_running_process_until_it_is_killed", root.path());
    wait_for(&mut first, "running");

    let error = ComponentLock::take(&dir, "sensor").unwrap_err();
    assert!(
        matches!(&error, RuntimeDirError::AlreadyRunning { holder: ComponentProcess::Process(pid), .. } if *pid == first.id())
    );
    assert_eq!(
        error.to_string(),
        format!(
            "component `sensor` is already running as process {}\n\
             help: stop that process first, or run this program in another system with `SCL_SYSTEM`",
            first.id()
        )
    );
    assert_eq!(ComponentLock::holder(&dir, "sensor"), Some(ComponentProcess::Process(first.id())));
    drop(ComponentLock::take(&dir, "controller").unwrap());
    UnixStream::connect(dir.path(ENDPOINT).unwrap()).unwrap();

    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(ComponentLock::holder(&dir, "sensor"), None);
    assert!(find(&dir, ENDPOINT).is_some(), "a killed process leaves its socket behind");
    let lock = ComponentLock::take(&dir, "sensor").unwrap();
    let bound = bind_ipc(&dir, ENDPOINT).unwrap();
    UnixStream::connect(dir.path(ENDPOINT).unwrap()).unwrap();
    drop(bound);
    lock.clear_leftovers().unwrap();
    assert_eq!(find(&dir, ENDPOINT), None);
}

#[test]
fn a_component_is_refused_twice_in_one_process_and_allowed_again_later() {
    let root = tempfile::tempdir().unwrap();
    let dir = rover(root.path());
    let first = ComponentLock::take(&dir, "sensor").unwrap();
    let error = ComponentLock::take(&dir, "sensor").unwrap_err();
    assert!(error.to_string().starts_with("component `sensor` is already running in this process"), "{error}");
    assert!(matches!(error, RuntimeDirError::AlreadyRunning { holder: ComponentProcess::ThisProcess, .. }));
    assert_eq!(ComponentLock::holder(&dir, "sensor"), Some(ComponentProcess::ThisProcess));
    drop(first);
    assert!(root.path().join("rover/sensor.lock").exists());
    ComponentLock::take(&dir, "sensor").unwrap();
}

#[test]
fn running_out_of_file_descriptors_is_a_clear_error() {
    if let Some(folder) = env::var_os(FOLDER) {
        return run_out_of_descriptors(&rover(Path::new(&folder)));
    }
    let root = tempfile::tempdir().unwrap();
    let mut second = second_process("running_out_of_file_descriptors_is_a_clear_error", root.path());
    assert!(second.wait().unwrap().success());
    assert_eq!(std::fs::read_dir(root.path().join("rover")).unwrap().count(), 0);
}

fn rover(root: &Path) -> SystemDir {
    let runtime = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| root.into())).unwrap();
    runtime.system("rover").unwrap()
}

fn second_process(test: &str, folder: &Path) -> Child {
    Command::new(env::current_exe().unwrap())
        .args(["--exact", &format!("runtime_dir_processes::{test}"), "--nocapture"])
        .env(FOLDER, folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits for a line of the second process. If that process fails, its output ends without the line.
fn wait_for(child: &mut Child, line: &str) {
    let lines = BufReader::new(child.stdout.as_mut().unwrap()).lines();
    assert!(
        lines.map(Result::unwrap).any(|printed| printed.ends_with(line)),
        "the second process did not print `{line}`"
    );
}

fn run_until_killed(dir: &SystemDir) {
    let _lock = ComponentLock::take(dir, "sensor").unwrap();
    let _bound = bind_ipc(dir, ENDPOINT).unwrap();
    println!("running");
    // Returns if the first process ends without killing this one.
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
        assert!(error.to_string().contains("help: the process is out of file descriptors"), "{error}");
    }
    assert_eq!(find(dir, ENDPOINT), None);
}
