//! Children of a program inherit nothing of its component, whether they run another program or not.

use crate::forking::Forking;
use crate::programs::{PLAIN, open};
use rustix::process::{Pid, Signal};
use scl_tests::{System, wait_until};
use std::fs;

/// The promise: a child that outlives its parent keeps neither the component's lock nor its sockets.
#[test]
fn a_child_keeps_nothing_of_the_component() {
    let system = System::new();
    let mut sink = open(&system, "sink");
    let mut source = open(&system, "source");
    source.get_ready();
    sink.tell("spawn");
    let child = Child(sink.next_line().parse().expect("a process id"));
    wait_until("the child runs its program", || child.name() == "sleep");
    let folder = system.runtime_dir().to_string_lossy().into_owned();
    let inherited = |target: &String| target.starts_with("socket:") || target.contains(&folder);
    assert!(!child.targets().iter().any(inherited), "{:?}", child.targets());
    sink.kill();
    source.ask("alone", "alone");
    let mut sink = open(&system, "sink");
    source.get_ready();
    source.ask("push 0 10", "pushed");
    sink.ask("pull 10", "0..10");
    assert_eq!(child.name(), "sleep", "the child outlived its parent");
}

/// The promise: a child that goes on with the program's code cannot use the component, and its end disturbs nothing of
/// the parent.
#[test]
fn a_forked_child_cannot_use_the_component() {
    let system = System::new();
    let forking = Forking::new();
    let mut source = forking.start(&system, PLAIN, "source");
    source.expect("open");
    let mut sink = open(&system, "sink");
    source.ask("ready", "ready");
    for command in ["ready", "publish_forever", "push_and_close"] {
        let said = forking.fork(&source, command);
        assert!(said.contains("belongs to the parent process"), "{command}: {said}");
        source.ask("reap", "reaped");
    }
    // The parent's lock, sockets and connections are as they were.
    let second = system.start(PLAIN, &["source"]).wait_for_exit();
    assert!(second.text().contains("is already running as process"), "{}", second.text());
    source.tell("push_and_close");
    sink.ask("pull 1000", "0..1000");
    assert!(source.wait_for_exit().status.success());
}

/// Ended with the test.
struct Child(i32);

impl Child {
    fn name(&self) -> String {
        fs::read_to_string(format!("/proc/{}/comm", self.0)).unwrap_or_default().trim().to_owned()
    }

    /// What its descriptors are open for.
    fn targets(&self) -> Vec<String> {
        let folder = fs::read_dir(format!("/proc/{}/fd", self.0)).expect("a running process");
        let links = folder.flatten().filter_map(|entry| fs::read_link(entry.path()).ok());
        links.map(|target| target.display().to_string()).collect()
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        if let Some(id) = Pid::from_raw(self.0) {
            let _ended = rustix::process::kill_process(id, Signal::KILL);
        }
    }
}
