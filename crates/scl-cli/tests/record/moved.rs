//! A file that loses its name while it is recorded: nobody would find the recording.

use super::recorder::{Recorder, messages, summary};
use super::source::Source;
use std::fs;
use std::path::Path;

/// What a recorder says, and its exit code, after `change` of its file in the folder of the source.
fn after(change: impl Fn(&Path)) -> (Source, String) {
    let mut source = Source::start_with(1);
    let recorder = source.record(&["g0"], &[]);
    source.send_numbers(100);
    change(&source.rover.path(""));
    let (code, _, error) = recorder.finish();
    assert_eq!(code, Some(1), "{error}");
    (source, error)
}

#[test]
fn a_removed_file_ends_the_recording() {
    let (_, error) = after(|folder| fs::remove_file(folder.join("flight.mcap")).unwrap());
    let expected = "error: recording stopped: the file was removed while it was being written\n --> flight.mcap\n";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn a_renamed_file_ends_the_recording_and_is_complete() {
    let (source, error) = after(|folder| fs::rename(folder.join("flight.mcap"), folder.join("other.mcap")).unwrap());
    assert!(error.contains("error: recording stopped: the file was renamed while it was being written\n"), "{error}");
    let other = source.rover.path("other.mcap");
    assert_eq!(summary(&other).stats.unwrap().message_count, messages(&other).len() as u64);
}

#[test]
fn a_replaced_file_ends_the_recording() {
    let (source, error) = after(|folder| {
        fs::write(folder.join("precious"), "precious").unwrap();
        fs::rename(folder.join("precious"), folder.join("flight.mcap")).unwrap();
    });
    assert!(
        error.contains("error: recording stopped: the file was replaced by another one while it was being written\n"),
        "{error}"
    );
    assert_eq!(fs::read_to_string(source.rover.path("flight.mcap")).unwrap(), "precious");
}

#[test]
fn a_folder_that_vanishes_ends_the_recording() {
    let source = Source::start_with(1);
    let folder = source.rover.path("flights");
    fs::create_dir(&folder).unwrap();
    let mut recorder = Recorder::spawn(source.rover.scl(&["record", "source.g0", "-o", "flights/flight.mcap"]));
    recorder.wait_for("connected to 1 gates");
    fs::remove_dir_all(&folder).unwrap();
    let (code, _, error) = recorder.finish();
    assert!(error.contains("error: recording stopped: the file was removed while it was being written\n"), "{error}");
    assert_eq!(code, Some(1));
}
