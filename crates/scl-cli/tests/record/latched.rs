//! Latched gates: a recording begins with their last message, once, and says so.

use super::recorder::{Recorder, figures, messages, sequences};
use super::source::Source;
use scl_record::recording::Recording;
use scl_tests::wait_until;
use std::time::{SystemTime, UNIX_EPOCH};

#[test]
fn a_recording_that_starts_later_begins_with_the_last_message() {
    let mut source = Source::start_latched();
    let sent: Vec<u64> = source.send_numbers(3).collect();
    let file = source.rover.path("flight.mcap");
    for round in 0..2 {
        let started = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos() as u64;
        let recorder = Recorder::start(&source.rover, 1, &["source.g0", "--format", "json", "--overwrite"]);
        let last = sent[2] + round;
        wait_until("the last message is recorded", || {
            recorder.signal("-USR1");
            sequences(&file, "/source/g0", 0) == [last]
        });
        source.send_numbers(1);
        wait_until("a new message is recorded", || {
            recorder.signal("-USR1");
            sequences(&file, "/source/g0", 0) == [last, last + 1]
        });
        assert_eq!(figures(&recorder.stop_json(), "source.g0"), (2, 0));
        let first = &messages(&file)[0];
        assert!(first.publish_time >= started, "no recording begins before it was started");
        let totals = Recording::open(std::slice::from_ref(&file)).unwrap().totals();
        assert_eq!(totals["source.g0"].latched, 1);
    }
}

#[test]
fn a_component_that_starts_again_begins_anew() {
    let mut source = Source::start_latched();
    let recorder = Recorder::start(&source.rover, 1, &["source.g0", "--format", "json"]);
    let file = source.rover.path("flight.mcap");
    source.send_numbers(1);
    let count = || messages(&file).len();
    wait_until("the first run is recorded", || count_after(&recorder, count) == 1);
    source.close();
    source.open();
    // Observed or latched, depending on when the recorder connects, and once.
    source.send_numbers(1);
    wait_until("the second run is recorded", || count_after(&recorder, count) == 2);
    assert_eq!(figures(&recorder.stop_json(), "source.g0"), (2, 0));
}

fn count_after(recorder: &Recorder, count: impl Fn() -> usize) -> usize {
    recorder.signal("-USR1");
    count()
}
