//! Programs that end: what they sent arrives, and stays readable.

use super::stage::{Account, IMAGE, QUEUE, Stage, share};

#[test]
fn a_camera_that_publishes_and_exits_loses_nothing() {
    let stage = Stage::new();
    for round in 0..10 {
        let (mut camera, mut viewer) = stage.camera_and_viewer();
        camera.tell(&format!("lend 0 {QUEUE} {IMAGE}"));
        if round % 2 == 0 {
            // Also if the viewer takes nothing until the camera has gone.
            let exit = camera.wait_for_exit();
            assert!(exit.status.success(), "{exit:?}");
            viewer.ask(&format!("receive {QUEUE}"), "0..4, 4 shared");
        } else {
            viewer.ask(&format!("receive {QUEUE}"), "0..4, 4 shared");
            let exit = camera.wait_for_exit();
            assert!(exit.status.success(), "{exit:?}");
        }
        stage.end([viewer]);
    }
}

/// The promise: what the viewer has received stays taken when it ends; what waited in its gate is lost.
#[test]
fn what_a_viewer_received_stays_taken_when_it_ends() {
    let stage = Stage::new();
    let mut camera = stage.open("camera");
    for round in 1..4 {
        let mut viewer = stage.open("viewer");
        share(&mut camera);
        camera.ask(&format!("lend 0 {QUEUE} {IMAGE}"), "4 shared");
        viewer.ask("receive 3", "0..3, 3 shared");
        let exit = viewer.wait_for_exit();
        assert!(exit.status.success(), "{exit:?}");
        camera.ask("viewer gone", "viewer");
        let found = Account::of(&mut camera, "frames");
        let expected = Account { published: round * QUEUE, taken: round * 3, dropped: 0, lost: round, waiting: 0 };
        assert_eq!(found, expected);
    }
    stage.end([camera]);
}

#[test]
fn views_outlive_the_camera() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    camera.ask(&format!("lend 0 {QUEUE} {IMAGE}"), "4 shared");
    viewer.ask(&format!("keep {QUEUE}"), "4 of 4 shared");
    let exit = camera.wait_for_exit();
    assert!(exit.status.success(), "{exit:?}");
    viewer.ask("kept", "0..4");
    let mut camera = stage.open("camera");
    share(&mut camera);
    stage.assert_good(&mut camera, &mut viewer, 10);
    viewer.ask("kept", "0..4");
    viewer.ask("release", "released");
    stage.assert_good(&mut camera, &mut viewer, 20);
    stage.end([camera, viewer]);
}
