//! A recorder that is killed: what it leaves is readable, and `scl recover` completes it.

use super::recorder::{messages, sequences, summary};
use super::source::Source;
use scl_tests::wait_until;
use std::fs;
use std::thread;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

#[test]
fn a_killed_recorder_loses_at_most_its_last_second() {
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &[]);
    let file = source.rover.path("flight.mcap");
    // Until some flushes have passed.
    for _ in 0..5000 {
        source.send_numbers(1);
        thread::sleep(Duration::from_millis(1));
    }
    recorder.signal("-KILL");
    let killed = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos() as u64;
    assert_eq!(recorder.finish().0, None);

    let kept = messages(&file);
    let last = kept.last().unwrap().log_time;
    // One second is the promise, the rest is for a machine that is busy with other tests.
    assert!(killed - last < 3_000_000_000, "{} ns", killed - last);
    let sequences: Vec<u32> = kept.iter().map(|message| message.sequence).collect();
    assert_eq!(sequences, (sequences[0]..=*sequences.last().unwrap()).collect::<Vec<_>>());

    let text = source.rover.text(&["recover", "flight.mcap"]);
    let expected = "messages; the old file is now `flight.mcap.bak`";
    assert_eq!(text, format!("flight.mcap: recovered {} {expected}\n", kept.len()));
    assert_eq!(messages(&file), kept);
    let summary = summary(&file);
    assert_eq!(summary.stats.unwrap().message_count, kept.len() as u64);
    assert!(summary.attachment_indexes.iter().any(|attachment| attachment.name == "plan.json"));
    let again = source.rover.text(&["recover", "flight.mcap"]);
    assert_eq!(again, format!("flight.mcap: complete already, {} messages\n", kept.len()));
}

#[test]
fn everything_is_readable_while_it_is_recorded() {
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &[]);
    let sent = source.send_numbers(50).collect::<Vec<_>>();
    let file = source.rover.path("flight.mcap");
    wait_until("the file has all messages", || sequences(&file, "/source/g0", sent[0]) == sent);
    let error = source.rover.error(&["recover", "flight.mcap"], 2);
    assert_eq!(error, "error: `flight.mcap` is being recorded\n  = help: stop the recorder first\n");
    let error = source.rover.error(&["record", "-o", "flight.mcap", "--overwrite"], 2);
    assert!(error.starts_with("error: `flight.mcap` is being recorded by another process\n"), "{error}");
    recorder.stop();
}

#[test]
fn signals_write_what_has_arrived() {
    let mut source = Source::start();
    for signal in ["-TERM", "-HUP"] {
        let recorder = source.record(&["g0"], &["--overwrite", "--sync", "100ms"]);
        let sent = source.send_numbers(50);
        let file = source.rover.path("flight.mcap");
        wait_until("everything has arrived", || {
            sequences(&file, "/source/g0", sent.start).last() == Some(&(sent.end - 1))
        });
        recorder.signal(signal);
        assert_eq!(recorder.finish().0, Some(0), "{signal}");
        assert_eq!(sequences(&file, "/source/g0", sent.start), sent.collect::<Vec<_>>(), "{signal}");
        summary(&file);
    }
}

#[test]
fn recovery_keeps_the_damaged_file_if_that_is_asked_for() {
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &[]);
    source.send_numbers(50);
    recorder.stop();
    let file = source.rover.path("flight.mcap");
    let count = messages(&file).len();
    let bytes = fs::read(&file).unwrap();
    fs::write(&file, &bytes[..bytes.len() - 100]).unwrap();
    let text = source.rover.text(&["recover", "flight.mcap", "-o", "whole.mcap"]);
    assert!(text.starts_with(&format!("whole.mcap: recovered {count} messages")), "{text}");
    assert_eq!(fs::read(&file).unwrap().len(), bytes.len() - 100);
    summary(&source.rover.path("whole.mcap"));
    let error = source.rover.error(&["recover", "flight.mcap", "-o", "whole.mcap"], 2);
    assert!(error.starts_with("error: `whole.mcap` exists already\n"), "{error}");
}
