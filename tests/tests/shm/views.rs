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
    let account = Account::when_taken(&mut camera, "frames");
    assert_eq!(account, Account { published: 20, taken: 20, dropped: 0, lost: 0, waiting: 0 });
    viewer.ask("release", "released");
    stage.assert_good(&mut camera, &mut viewer, 30);
    stage.end([camera, viewer]);
}
