//! Memory is bounded by the topology: a stopped subscriber costs its publisher its queue and no more.

use crate::programs::BOUNDED;
use scl_tests::on_each_transport;

#[test]
fn a_stopped_subscriber_of_large_messages_costs_its_queue_and_no_more() {
    on_each_transport(|system| {
        let mut viewer = system.start(BOUNDED, &["viewer"]);
        let mut camera = system.start(BOUNDED, &["camera"]);
        camera.expect("ready");
        viewer.pause();
        let before = camera.peak_memory();
        // 100 MiB are published. 8 MiB may wait, a few more are on their way, and one is being encoded.
        camera.tell("100");
        let line = camera.next_line();
        let waiting: u64 = line.trim_start_matches("waiting ").parse().expect("a number");
        assert!((8..=12).contains(&waiting), "{line}");
        let growth = camera.peak_memory() - before;
        assert!(growth < 16 << 10, "{growth} KiB for 8 frames of 1 MiB");
        viewer.resume();
        viewer.expect("received the last frame");
    });
}
