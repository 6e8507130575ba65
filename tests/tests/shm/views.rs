//! Views that are kept: as many as the queue and 8 are in shared memory, further ones are copies.

use super::stage::{Account, IMAGE, QUEUE, Stage, share};
use crate::forking::Forking;
use crate::programs::IMAGES;

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

/// The promise: the memory of a message goes back to its sender when the program that has received it is done with it,
/// whatever a forked child does with the copy that it inherits.
#[test]
fn views_that_a_forked_child_drops_are_still_those_of_its_parent() {
    let stage = Stage::new();
    let forking = Forking::new();
    let mut viewer = forking.start(&stage.system, IMAGES, "keeper");
    viewer.expect("open");
    let mut camera = stage.open("camera");
    share(&mut camera);
    for number in 0..QUEUE {
        camera.ask(&format!("lend {number} {} {IMAGE}", number + 1), "1 shared");
        viewer.ask("keep", "kept");
    }
    assert_eq!(forking.fork(&viewer, "kept\nrelease"), "0..4\nreleased\n");
    // The sender would fill the memory again.
    for number in QUEUE..10 * QUEUE {
        camera.ask(&format!("lend {number} {} {IMAGE}", number + 1), "1 shared");
        viewer.ask("receive", &number.to_string());
    }
    viewer.ask("kept", "0..4");
    viewer.ask("release", "released");
    stage.end([camera, viewer]);
}
