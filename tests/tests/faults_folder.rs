//! What can happen to the runtime folder: removed while programs run, somebody else's, a link, full.

use scl_tests::{Place, Process};
use std::fs;
use std::os::unix::fs::{chown, symlink};
use std::path::Path;
use std::process::Command;

const PEER: &str = env!("CARGO_BIN_EXE_peer");

fn open(place: &Place, component: &str) -> Process {
    let mut process = place.start(PEER, &[component]);
    process.says("open");
    process
}

fn start_in(folder: &Path) -> Process {
    Process::start(PEER, &["sink"], &[("SCL_RUNTIME_DIR", folder.as_os_str())])
}

fn assert_refused(folder: &Path, why: &str) {
    let (status, said) = start_in(folder).ends();
    let said = said.join("\n");
    assert!(!status.success());
    assert!(said.contains("component `sink` cannot be opened") && said.contains(why), "{said}");
}

#[test]
fn programs_that_run_go_on_when_the_folder_is_removed() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    fs::remove_dir_all(place.runtime_dir().join("six")).expect("removed");
    source.does("publish 0 100", "published");
    sink.does("receive 100", "0..100");
    source.does("push 0 100", "pushed");
    sink.does("pull 100", "0..100");
    sink.tell("serve 1");
    source.does("call 4", "8");
    sink.says("served");
    // Started anew, they make the folder again and find each other.
    source.kill();
    sink.kill();
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("publish 0 10", "published");
    sink.does("receive 10", "0..10");
}

#[test]
fn a_folder_that_is_a_link_is_refused() {
    let place = Place::new("ipc");
    let (real, link) = (place.runtime_dir().join("real"), place.runtime_dir().join("link"));
    fs::create_dir(&real).expect("made");
    symlink(&real, &link).expect("linked");
    assert_refused(&link, "a symbolic link");
}

#[test]
fn a_folder_of_somebody_else_is_refused() {
    let place = Place::new("ipc");
    let folder = place.runtime_dir().join("foreign");
    fs::create_dir(&folder).expect("made");
    if let Err(error) = chown(&folder, Some(65534), None) {
        // Only root can give a folder away; for others, root's own folder is the foreign one.
        println!("not root ({error}): trying `/`");
        return assert_refused(Path::new("/"), "0");
    }
    assert_refused(&folder, "65534");
}

#[test]
fn a_full_folder_is_said_and_serves_again_when_there_is_room() {
    let place = Place::new("ipc");
    let folder = place.runtime_dir().join("small");
    fs::create_dir(&folder).expect("made");
    let mount = Command::new("mount").args(["-t", "tmpfs", "-o", "size=16k,mode=0700", "tmpfs"]).arg(&folder).status();
    if !mount.is_ok_and(|status| status.success()) {
        println!("SKIPPED: no right to mount a small file system");
        return;
    }
    let _mounted = Unmount(&folder);
    let filler = folder.join("filler");
    // All of the 16 KiB and what is left of the last page.
    let _full = fs::write(&filler, vec![0; 1 << 20]);
    let (status, said) = start_in(&folder).ends();
    let said = said.join("\n");
    assert!(!status.success() && said.contains("No space left"), "{said}");
    fs::remove_file(&filler).expect("removed");
    start_in(&folder).says("open");
}

struct Unmount<'p>(&'p Path);

impl Drop for Unmount<'_> {
    fn drop(&mut self) {
        let _unmounted = Command::new("umount").arg("--lazy").arg(self.0).status();
    }
}
