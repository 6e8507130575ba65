//! Recording in memory, and writing it when something has happened.

use super::recorder::{Recorder, messages, sequences, summary};
use super::source::Source;
use scl_tests::wait_until;

#[test]
fn a_ring_is_written_when_it_is_triggered() {
    let mut source = Source::start();
    let mut recorder = Recorder::start(&source.rover, 1, &["source.g0", "--ring", "1h"]);
    let file = source.rover.path("flight.mcap");
    assert!(!file.exists());
    // The first ones may be sent before the gate knows the recorder, and it may not have read the last ones.
    let mut runs = 0;
    wait_until("the ring has a message", || {
        source.send_numbers(1);
        runs += 1;
        let written = source.rover.text(&["record", "--trigger"]);
        assert_eq!(written.lines().count(), 1, "{written}");
        !messages(written.trim_end().as_ref()).is_empty()
    });
    assert!(file.exists());

    let sent = source.send_numbers(100).collect::<Vec<_>>();
    wait_until("the ring has all messages", || {
        runs += 1;
        let written = source.rover.text(&["record", "--trigger"]);
        summary(written.trim_end().as_ref());
        sequences(written.trim_end().as_ref(), "/source/g0", sent[0]) == sent
    });
    let next = |number: i32| source.rover.path(&format!("flight_{number:04}.mcap"));
    recorder.signal("-USR1");
    recorder.wait_for(next(runs + 1).to_str().unwrap());
    assert_eq!(sequences(&next(runs + 1), "/source/g0", sent[0]), sent);
    recorder.signal("-INT");
    assert_eq!(recorder.finish().0, Some(0));
    assert!(!next(runs + 2).exists());
    let error = source.rover.error(&["record", "--trigger"], 2);
    assert!(error.starts_with("error: no recorder with a ring is running for system `rover`\n"), "{error}");
}

#[test]
fn a_ring_is_written_at_the_end_if_that_is_asked_for() {
    let mut source = Source::start();
    let arguments = ["source.g0", "--ring", "1h", "--save-at-exit", "--memory", "64KiB"];
    let recorder = Recorder::start(&source.rover, 1, &arguments);
    for number in 0..200_u64 {
        source.send("g0", &number.to_le_bytes().repeat(128));
        // No faster than the recorder reads, whose queue is as small as the ring.
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    recorder.stop();
    let file = source.rover.path("flight.mcap");
    let kept = messages(&file);
    assert!(kept.len() > 10 && kept.len() < 64, "{}", kept.len());
    assert_eq!(kept.last().unwrap().sequence, 199);
    summary(&file);
}
