//! Recordings in several files: each is complete in itself, and only files of the same run are deleted.

use super::recorder::{Recorder, figures, messages, summary};
use super::source::Source;
use scl_tests::wait_until;
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

#[test]
fn a_recording_is_split_by_size_without_losing_a_message() {
    let mut source = Source::start();
    let report = record_500(&mut source, &["--split", "64KiB"]);
    let files: Vec<PathBuf> =
        report["files"].as_array().unwrap().iter().map(|file| file["path"].as_str().unwrap().into()).collect();
    assert!(files.len() > 5, "{report}");
    let mut numbers = Vec::new();
    for (index, file) in files.iter().enumerate() {
        assert_eq!(file.to_str().unwrap(), format!("flight_{:04}.mcap", index + 1));
        let file = source.rover.path(file.to_str().unwrap());
        let summary = summary(&file);
        assert!(summary.attachment_indexes.iter().any(|attachment| attachment.name == "plan.json"));
        assert!(summary.attachment_indexes.iter().any(|attachment| attachment.name == "topology.yaml"));
        assert_eq!(summary.metadata_indexes.len(), 1);
        numbers.extend(messages(&file).into_iter().map(|message| message.sequence));
    }
    assert_eq!(numbers, (numbers[0]..=*numbers.last().unwrap()).collect::<Vec<_>>());
    assert_eq!(numbers.len() as u64, figures(&report, "source.g0").0);
}

/// Records 500 messages of 1 KiB, and perhaps some before.
fn record_500(source: &mut Source, arguments: &[&str]) -> Value {
    let arguments = [&["source.g0", "--format", "json"], arguments].concat();
    let recorder = Recorder::start(&source.rover, 1, &arguments);
    let first = source.rover.path("flight_0001.mcap");
    wait_until("the gate is seen", || {
        source.send("g0", b"");
        recorder.signal("-USR1");
        !messages(&first).is_empty()
    });
    for number in 0..500_u64 {
        source.send("g0", &number.to_le_bytes().repeat(128));
    }
    let last = source.sent("g0") - 1;
    wait_until("the last message is recorded", || {
        recorder.signal("-USR1");
        let files = fs::read_dir(source.rover.path("")).unwrap().flatten().map(|entry| entry.path());
        let mut files: Vec<_> = files.filter(|path| path.extension().is_some_and(|it| it == "mcap")).collect();
        files.sort();
        // The newest may have been begun after the last message.
        let newest = files.iter().rev().take(2).find_map(|file| messages(file).pop());
        newest.is_some_and(|message| u64::from(message.sequence) == last)
    });
    let report = recorder.stop_json();
    let (recorded, lost) = figures(&report, "source.g0");
    assert!(recorded >= 500 && lost == 0, "{report}");
    report
}

#[test]
fn only_the_newest_files_of_this_run_are_kept() {
    let mut source = Source::start();
    let other = source.rover.path("flight_0000.mcap");
    fs::write(&other, "of another run").unwrap();
    let report = record_500(&mut source, &["--split", "64KiB", "--keep", "3"]);
    let files = report["files"].as_array().unwrap();
    assert_eq!(files.len(), 3, "{report}");
    let names = fs::read_dir(source.rover.path("")).unwrap().flatten();
    let names: Vec<_> = names.map(|entry| entry.file_name().into_string().unwrap()).collect();
    let recordings = names.iter().filter(|name| name.ends_with(".mcap")).count();
    assert_eq!(recordings, 4, "{names:?}");
    assert!(report["deleted"].as_u64().unwrap() > 3);
    assert_eq!(fs::read_to_string(&other).unwrap(), "of another run");
}

#[test]
fn a_recording_is_split_by_time() {
    let source = Source::start();
    let recorder = Recorder::start(&source.rover, 1, &["source.g0", "--split", "200ms"]);
    let third = source.rover.path("flight_0003.mcap");
    wait_until("the third file is begun", || third.exists());
    let (code, _, _) = {
        recorder.signal("-INT");
        recorder.finish()
    };
    // Nothing was sent.
    assert_eq!(code, Some(1));
    summary(&source.rover.path("flight_0001.mcap"));
}
