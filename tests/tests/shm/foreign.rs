//! Segments that are stale, and files that are no segments.

use super::stage::{IMAGE, Stage, share};
use std::fs;
use std::path::PathBuf;

/// What is left of a program that was killed long ago, or of another version of the engine.
#[test]
fn stale_and_damaged_files_are_no_obstacle() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    camera.ask(&format!("lend 0 2 {IMAGE}"), "2 shared");
    viewer.ask("keep 1", "1 of 1 shared");
    let files = stage.system.shared_files("images");
    camera.kill();
    viewer.kill();
    // Cut, and filled with other bytes.
    for (index, file) in files.iter().enumerate() {
        match index % 3 {
            0 => fs::write(file, b"").expect("cut"),
            1 => fs::write(file, [0xa5; 5000]).expect("damaged"),
            _ => {}
        }
    }
    let garbage = format!("/dev/shm/{}garbage", stage.system.shared_prefix("images"));
    fs::write(&garbage, [0xff; 100]).expect("garbage");
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    stage.assert_good(&mut camera, &mut viewer, 10);
    stage.end([camera, viewer]);
}

/// A program can be killed between creating a file and giving it a length. To the engine, another program is creating
/// that file, and it waits.
#[test]
fn files_that_a_killed_program_had_just_created_are_no_obstacle() {
    let stage = Stage::new();
    let (mut camera, viewer) = stage.camera_and_viewer();
    viewer.pause();
    camera.kill();
    empty(&stage, &[".connection", ".data"]);
    camera = stage.open("camera");
    viewer.resume();
    share(&mut camera);

    camera.pause();
    viewer.kill();
    empty(&stage, &[".connection", ".dynamic"]);
    let mut viewer = stage.open("viewer");
    viewer.tell("stream");
    camera.resume();
    camera.tell("stream 100000");
    for program in [&mut camera, &mut viewer] {
        program.expect("flows");
    }
    viewer.ask("ready", "ready");
    share(&mut camera);
    stage.assert_good_after(&mut camera, &mut viewer, 1 << 40);
    stage.end([camera, viewer]);
}

/// Puts empty files in the place of those with one of these endings. What living programs have mapped stays as it is.
fn empty(stage: &Stage, endings: &[&str]) {
    let files = stage.system.shared_files("images");
    let is_chosen = |file: &&PathBuf| endings.iter().any(|ending| file.to_string_lossy().ends_with(ending));
    let mut emptied = 0;
    for file in files.iter().filter(is_chosen) {
        fs::remove_file(file).expect("removed");
        fs::write(file, b"").expect("created");
        emptied += 1;
    }
    assert!(emptied >= endings.len(), "in {files:?}");
}

/// A file that disappears under running programs costs nothing that they have mapped.
#[test]
fn files_that_are_removed_while_programs_run_do_no_damage() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    stage.assert_good(&mut camera, &mut viewer, 0);
    for file in stage.system.shared_files("images") {
        fs::remove_file(file).expect("removed");
    }
    camera.tell(&format!("lend 10 12 {IMAGE}"));
    camera.next_line();
    viewer.tell("receive_up_to 11");
    let received = viewer.next_line();
    assert!(received.starts_with("10..12, "), "{received}");
    camera.kill();
    viewer.kill();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    stage.assert_good(&mut camera, &mut viewer, 20);
    stage.end([camera, viewer]);
}
