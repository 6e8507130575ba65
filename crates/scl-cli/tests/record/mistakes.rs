//! Wrong arguments and files.

use super::source::Source;
use crate::rover::Rover;
use expect_test::expect;
use std::fs;

#[test]
fn names_that_do_not_exist_are_corrected() {
    let source = Source::start();
    let error = |arguments: &[&str]| source.rover.error(&[&["record"], arguments].concat(), 2);
    assert!(error(&["sorce"]).contains("did you mean `source`?"));
    assert!(error(&["source.measurement"]).contains("did you mean `source.measurements`?"));
    assert!(error(&["--exclude", "source.g11"]).contains("component `source` has no gate `g11`"));
    assert!(error(&["--system", "rovr"]).contains("did you mean `rover`?"));
    assert!(error(&["--topology", "none.yaml"]).starts_with("error: cannot read `none.yaml`: No such file"));
    assert_eq!(fs::read_dir(source.rover.path("")).unwrap().flatten().filter(is_recording).count(), 0);
}

#[test]
fn a_system_must_exist() {
    let error = Rover::stopped().error(&["record"], 2);
    assert!(error.starts_with("error: no system is running\n"), "{error}");
}

#[test]
fn existing_files_are_kept() {
    let source = Source::start();
    fs::write(source.rover.path("flight.mcap"), "precious").unwrap();
    fs::write(source.rover.path("long_0001.mcap"), "precious").unwrap();
    expect![[r#"
        error: `flight.mcap` exists already
          = help: choose another name with `-o`, or replace it with `--overwrite`
    "#]]
    .assert_eq(&source.rover.error(&["record", "-o", "flight.mcap"], 2));
    let error = source.rover.error(&["record", "-o", "long.mcap", "--split", "1min"], 2);
    assert!(error.starts_with("error: `long_0001.mcap` exists already\n"), "{error}");
    let error = source.rover.error(&["record", "-o", "nowhere/flight.mcap"], 2);
    assert!(error.starts_with("error: cannot create `nowhere/flight.mcap`: No such file"), "{error}");
    assert_eq!(fs::read_to_string(source.rover.path("flight.mcap")).unwrap(), "precious");
}

#[test]
fn wrong_limits_are_explained() {
    let rover = Rover::stopped();
    for (arguments, expected) in [
        (&["--split", "5"][..], "expected a size such as `1GiB` or a time such as `10min`"),
        (&["--keep", "3"], "--split"),
        (&["--split", "1min", "--keep", "0"], "0 is not in 1.."),
        (&["--for", "5"], "the unit is missing: write `5s` or `5ms`"),
        (&["--ring", "5s", "--split", "1min"], "cannot be used with"),
        (&["--save-at-exit"], "--ring"),
    ] {
        let error = rover.error(&[&["record"], arguments].concat(), 2);
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
}

#[test]
fn only_recordings_are_recovered() {
    let rover = Rover::stopped();
    fs::write(rover.path("flight.mcap"), "").unwrap();
    fs::write(rover.path("notes.txt"), "not a recording").unwrap();
    for (file, expected) in [
        (
            "fligt.mcap",
            "error: cannot open `fligt.mcap`: No such file or directory (os error 2)\n  = help: did you mean `flight.mcap`?\n",
        ),
        ("flight.mcap", "error: `flight.mcap` is empty\n"),
        ("notes.txt", "error: `notes.txt` is not an MCAP file: it does not begin with MCAP's magic bytes\n"),
        (".", "error: `.` is not a file\n"),
    ] {
        assert_eq!(rover.error(&["recover", file], 2), expected);
    }
}

fn is_recording(entry: &fs::DirEntry) -> bool {
    entry.file_name().to_string_lossy().ends_with(".mcap")
}
