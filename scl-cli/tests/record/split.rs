//! Recordings in several files: each is complete in itself, and only files of the same run are deleted.

use super::recorder::{Recorder, figures, messages, summary};
use super::source::Source;
use scl_tests::wait_until;
use std::fs;
use std::path::PathBuf;

#[test]
fn a_recording_is_split_by_size_without_losing_a_message() {
    let mut source = Source::start();
    let recorder = Recorder::start(&source.rover, 1, &["source.g0", "--split", "64KiB", "--format", "json"]);
    for number in 0..500_u64 {
        source.send("g0", &number.to_le_bytes().repeat(128));
    }
    let report = recorder.stop_json();
    assert_eq!(figures(&report, "source.g0"), (500, 0));
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
    assert_eq!(numbers, (0..500).collect::<Vec<_>>());
}

#[test]
fn only_the_newest_files_of_this_run_are_kept() {
    let mut source = Source::start();
    let other = source.rover.path("flight_0000.mcap");
    fs::write(&other, "of another run").unwrap();
    let arguments = ["source.g0", "--split", "64KiB", "--keep", "3", "--format", "json"];
    let recorder = Recorder::start(&source.rover, 1, &arguments);
    for number in 0..500_u64 {
        source.send("g0", &number.to_le_bytes().repeat(128));
    }
    let report = recorder.stop_json();
    assert_eq!(figures(&report, "source.g0"), (500, 0));
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
