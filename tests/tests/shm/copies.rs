//! Images of 4 MiB pass without a copy: where one program fills them, the other reads them.

use super::stage::{Account, IMAGE, QUEUE, Stage};
use crate::programs::{IMAGES, open_with};
use scl::TransportKind;
use scl_tests::System;

#[test]
fn images_that_are_filled_in_place_are_read_in_place() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    let rounds = 10;
    for round in 0..rounds {
        stage.assert_good(&mut camera, &mut viewer, round * QUEUE);
    }
    Account::assert_all_taken(&mut camera, "frames", rounds * QUEUE);
    stage.end([camera, viewer]);
}

#[test]
fn types_of_fixed_layout_are_written_and_viewed_in_place() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    for number in 0..10 {
        camera.ask(&format!("draw {number} {}", number + 1), "1 shared");
        viewer.ask("view 1", &format!("{number}..{}, 1 shared", number + 1));
    }
    stage.end([camera, viewer]);
}

#[test]
fn jobs_wait_and_none_is_lost() {
    let stage = Stage::new();
    let (mut camera, mut worker) = (stage.open("camera"), stage.open("worker"));
    camera.ask("lends jobs", "lends");
    camera.tell(&format!("push 0 100 {IMAGE}"));
    worker.ask("pull 100", "0..100, 100 shared");
    camera.expect("pushed");
    Account::assert_all_taken(&mut camera, "jobs", 100);
    stage.end([camera, worker]);
}

/// Messages of the program's own are copied once, into shared memory; short ones stay in the socket.
#[test]
fn long_messages_are_in_shared_memory_and_short_ones_are_not() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    for (number, length, shared) in [(0, IMAGE, 1), (1, 100, 0), (2, IMAGE / 2, 1), (3, 9, 0), (4, 64 << 10, 1)] {
        camera.ask(&format!("send {number} {} {length}", number + 1), "sent");
        viewer.ask("receive 1", &format!("{number}..{}, {shared} shared", number + 1));
    }
    stage.end([camera, viewer]);
}

/// The same programs on sockets: the memory is from the heap.
#[test]
fn the_same_programs_run_without_shared_memory() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let system = System::over(kind);
        let (mut camera, mut viewer) = (open_with(&system, IMAGES, "camera"), open_with(&system, IMAGES, "viewer"));
        camera.ask("viewer here", "viewer");
        camera.ask(&format!("lend 0 {QUEUE} {IMAGE}"), "0 shared");
        viewer.ask(&format!("receive {QUEUE}"), "0..4, 0 shared");
        camera.ask("draw 7 8", "0 shared");
        viewer.ask("view 1", "7..8, 0 shared");
    }
}

/// A connection is chosen by name, by either end.
#[test]
fn single_connections_can_use_shared_memory() {
    for (choice, frames, pictures) in [
        ("ipc,camera.frames=shm", 1, 0),
        ("tcp,viewer.pictures=shm", 0, 1),
        ("shm,viewer.frames=ipc", 0, 1),
        ("camera.frames=shm,viewer.frames=tcp", 0, 0),
    ] {
        let system = System::over(TransportKind::Shm);
        // What the listening end reads counts.
        let mut camera = system.start_with(IMAGES, &["camera"], &[("SCL_TRANSPORT", choice)]);
        camera.expect("open");
        let mut viewer = system.start_with(IMAGES, &["viewer"], &[("SCL_TRANSPORT", "ipc")]);
        viewer.expect("open");
        camera.ask("viewer here", "viewer");
        if frames == 1 {
            camera.ask("lends frames", "lends");
        }
        if pictures == 1 {
            camera.ask("lends pictures", "lends");
        }
        camera.ask(&format!("send 0 1 {IMAGE}"), "sent");
        viewer.ask("receive 1", &format!("0..1, {frames} shared"));
        camera.tell("draw 1 2");
        camera.next_line();
        viewer.ask("view 1", &format!("1..2, {pictures} shared"));
    }
}

#[test]
fn a_gate_that_does_not_exist_cannot_be_chosen() {
    let system = System::new();
    let mut camera = system.start_with(IMAGES, &["camera"], &[("SCL_TRANSPORT", "ipc,camera.frame=shm")]);
    let error = camera.next_line();
    assert!(error.ends_with("(`camera.frame=shm`); did you mean `frames`?"), "{error}");
}
