//! Programs that end: what they sent arrives, and stays readable.

use super::stage::{IMAGE, QUEUE, Stage, share};

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
