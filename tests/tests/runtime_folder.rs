//! Runtime folders that are removed while programs run, belong to another user, are symbolic links, or are full.

use crate::programs::{PEER, open};
use scl_needs::needs;
use scl_tests::{Process, System, wait_until};
use std::fs;
use std::os::unix::fs::{chown, symlink};
use std::path::Path;
use std::process::Command;

#[test]
fn connected_programs_continue_when_the_folder_is_removed() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    fs::remove_dir_all(system.runtime_dir().join("six")).expect("removed");
    source.ask("publish 0 100", "published");
    sink.ask("receive 100", "0..100");
    source.ask("push 0 100", "pushed");
    sink.ask("pull 100", "0..100");
    sink.tell("serve 1");
    source.ask("call 4", "8");
    sink.expect("served");
}

#[test]
fn after_the_folder_is_removed_a_restarted_peer_is_found_again() {
    for restarted in ["source", "sink"] {
        let system = System::new();
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.get_ready();
        fs::remove_dir_all(system.runtime_dir().join("six")).expect("removed");
        if restarted == "source" {
            source.kill();
            source = open(&system, "source");
        } else {
            sink.kill();
            // What is sent before the source has noticed is on its way to the dead sink and lost with it.
            source.ask("alone", "alone");
            sink = open(&system, "sink");
        }
        source.get_ready();
        source.ask("publish 0 100", "published");
        sink.ask("receive 100", "0..100");
        source.ask("push 0 100", "pushed");
        sink.ask("pull 100", "0..100");
        sink.tell("serve 1");
        source.ask("call 4", "8");
        sink.expect("served");
    }
}

#[test]
fn after_the_folder_is_removed_a_second_program_for_a_component_is_refused() {
    let system = System::new();
    let mut sink = open(&system, "sink");
    let announcement = system.runtime_dir().join("six/sink.json");
    fs::remove_dir_all(system.runtime_dir().join("six")).expect("removed");
    // The file of the lock is there before the lock is taken.
    wait_until("the running program has its lock again, and is announced", || announcement.exists());
    let exit = system.start(PEER, &["sink"]).wait_for_exit();
    assert!(!exit.status.success(), "{exit:?}");
    assert!(exit.text().contains(&sink.id().to_string()), "the running process is named: {exit:?}");
    // The one that was first still serves.
    let mut source = open(&system, "source");
    source.ask("push 0 10", "pushed");
    sink.ask("pull 10", "0..10");
}

#[test]
fn a_symbolic_link_is_refused() {
    let system = System::new();
    let (real, link) = (system.runtime_dir().join("real"), system.runtime_dir().join("link"));
    fs::create_dir(&real).expect("created");
    symlink(&real, &link).expect("linked");
    assert_refused(&link, "a symbolic link");
}

#[needs("root")]
#[test]
fn a_folder_of_another_user_is_refused() {
    let system = System::new();
    let folder = system.runtime_dir().join("foreign");
    fs::create_dir(&folder).expect("created");
    chown(&folder, Some(65534), None).expect("given away");
    assert_refused(&folder, "65534");
}

#[needs("the right to mount")]
#[test]
fn a_full_folder_is_reported_and_works_again_when_there_is_room() {
    let system = System::new();
    let folder = system.runtime_dir().join("small");
    fs::create_dir(&folder).expect("created");
    let mount = Command::new("mount").args(["-t", "tmpfs", "-o", "size=16k,mode=0700", "tmpfs"]).arg(&folder).status();
    assert!(mount.is_ok_and(|status| status.success()));
    let _mounted = Unmount(&folder);
    let filler = folder.join("filler");
    // All of the 16 KiB; writing fails when they are used up.
    let _full = fs::write(&filler, vec![0; 1 << 20]);
    let exit = start_in(&folder).wait_for_exit();
    assert!(!exit.status.success() && exit.text().contains("No space left"), "{exit:?}");
    fs::remove_file(&filler).expect("removed");
    start_in(&folder).expect("open");
}

fn start_in(folder: &Path) -> Process {
    Process::start(PEER, &["sink"], &[("SCL_RUNTIME_DIR", folder.as_os_str())])
}

fn assert_refused(folder: &Path, reason: &str) {
    let exit = start_in(folder).wait_for_exit();
    let text = exit.text();
    assert!(!exit.status.success());
    assert!(text.contains("component `sink` cannot be opened") && text.contains(reason), "{text}");
}

struct Unmount<'p>(&'p Path);

impl Drop for Unmount<'_> {
    fn drop(&mut self) {
        let _unmounted = Command::new("umount").arg("--lazy").arg(self.0).status();
    }
}
