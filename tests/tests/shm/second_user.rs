//! Another user of the machine can neither read nor disturb what is in shared memory.
//!
//! Only root can start programs as another user, here 65534.

use super::stage::{IMAGE, Stage};
use scl_needs::needs;
use std::os::unix::process::CommandExt;
use std::process::{Command, Output};

const NOBODY: u32 = 65534;

#[needs("root")]
#[test]
fn another_user_cannot_open_or_remove_anything() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    camera.ask(&format!("lend 0 2 {IMAGE}"), "2 shared");
    viewer.ask("keep 1", "1 of 1 shared");
    let mut files = stage.system.shared_files("images");
    assert!(!files.is_empty(), "no files, so nothing is tested");
    files.push(stage.system.runtime_dir().join("images/shm"));
    for file in &files {
        let path = file.to_str().expect("a path in UTF-8");
        for attempt in
            ["cat \"$0\"", ": < \"$0\"", ": >> \"$0\"", "rm \"$0\"", "mv \"$0\" \"$0\".x", "chmod 777 \"$0\""]
        {
            let output = as_nobody(&["sh", "-c", attempt, path]);
            assert!(!output.status.success(), "{attempt} {path}: {output:?}");
        }
        assert!(file.exists(), "{path}");
    }
    stage.assert_good(&mut camera, &mut viewer, 10);
    viewer.ask("kept", "0..1");
    stage.end([camera, viewer]);
}

/// `/dev/shm` belongs to everybody, so another user can create files with our names first.
#[needs("root")]
#[test]
fn files_of_another_user_are_refused_by_name() {
    let stage = Stage::new();
    let foreign = format!("/dev/shm/{}foreign", stage.system.shared_prefix("images"));
    assert!(as_nobody(&["sh", "-c", "echo foreign > \"$0\"", &foreign]).status.success());
    let mut camera = stage.system.start(crate::programs::IMAGES, &["camera"]);
    let error = camera.next_line();
    assert!(error.starts_with("error: gate `camera.frames` cannot be opened") && error.contains(&foreign), "{error}");
    assert!(as_nobody(&["rm", &foreign]).status.success());
    drop(camera);
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    stage.assert_good(&mut camera, &mut viewer, 0);
    stage.end([camera, viewer]);
}

fn as_nobody(command: &[&str]) -> Output {
    Command::new(command[0]).args(&command[1..]).uid(NOBODY).gid(NOBODY).output().expect("a command of another user")
}
