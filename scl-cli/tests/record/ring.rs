//! Recording in memory, and writing it when something has happened.

use super::recorder::{Recorder, messages, summary};
use super::source::Source;
use scl_tests::wait_until;

#[test]
fn a_ring_is_written_when_it_is_triggered() {
    let mut source = Source::start();
    let mut recorder = Recorder::start(&source.rover, 1, &["source.g0", "--ring", "1h"]);
    let file = source.rover.path("flight.mcap");
    source.send_numbers(0..100);
    assert!(!file.exists());
    // The recorder may not have read everything yet.
    let mut runs = 0;
    wait_until("the ring has everything", || {
        runs += 1;
        let written = source.rover.text(&["record", "--trigger"]);
        assert_eq!(written.lines().count(), 1, "{written}");
        messages(written.trim_end().as_ref()).len() == 100
    });
    assert!(file.exists());

    source.send_numbers(100..150);
    let second = source.rover.path(&format!("flight_{:04}.mcap", runs + 1));
    recorder.signal("-USR1");
    recorder.wait_for(second.to_str().unwrap());
    let in_second = messages(&second);
    assert_eq!(in_second[..100].len(), 100);
    summary(&second);
    recorder.signal("-INT");
    assert_eq!(recorder.finish().0, Some(0));
    assert!(!source.rover.path(&format!("flight_{:04}.mcap", runs + 2)).exists());
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
