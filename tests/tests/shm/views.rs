//! Views that are kept: as many as the queue and 8 are in shared memory, further ones are copies.

use super::stage::{Account, IMAGE, QUEUE, Stage};

#[test]
fn views_beyond_the_limit_are_copied_and_stay_as_they_are() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    let limit = QUEUE + 8;
    for number in 0..20 {
        camera.ask(&format!("send {number} {} {IMAGE}", number + 1), "sent");
        let kept = number + 1;
        viewer.ask("keep 1", &format!("{} of {kept} shared", kept.min(limit)));
    }
    viewer.ask("kept", "0..20");
    Account::assert_all_taken(&mut camera, "frames", 20);
    viewer.ask("release", "released");
    stage.assert_good(&mut camera, &mut viewer, 30);
    stage.end([camera, viewer]);
}
