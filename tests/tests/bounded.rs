//! Memory is bounded by the file: a stopped subscriber costs its publisher no more than its queue.

use scl_tests::{Process, on_each_transport};

const PROGRAM: &str = env!("CARGO_BIN_EXE_bounded");

/// The most memory that a program has used so far, in KiB.
fn peak(process: &Process) -> u64 {
    process.status("VmHWM").trim_end_matches(" kB").parse().expect("a number")
}

#[test]
fn a_stopped_subscriber_of_large_messages_costs_its_queue_and_no_more() {
    on_each_transport(|place| {
        let mut viewer = place.start(PROGRAM, &["viewer"]);
        let mut camera = place.start(PROGRAM, &["camera"]);
        camera.says("ready");
        viewer.stop();
        let before = peak(&camera);
        // 100 MiB, of which 8 may wait; one more is being written, and one being made.
        camera.does("100", "waiting 8");
        let more = peak(&camera) - before;
        assert!(more < 16 << 10, "{more} KiB for 8 frames of 1 MiB");
        viewer.go_on();
        viewer.says("seen the last");
    });
}
