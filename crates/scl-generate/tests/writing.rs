//! Files on disk: only what differs is written, and as a whole.

use scl_generate::{File, Outcome, OutputError, is_current, write};
use std::fs;
use std::io::Read;
use std::os::unix::fs::{PermissionsExt, symlink};

fn file(text: &str) -> File {
    File { name: "rover_scl.h".to_owned(), text: text.to_owned() }
}

#[test]
fn a_file_is_written_only_if_its_content_changes() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("new/folder");
    assert_eq!(write(&inner, &file("one")).unwrap(), Outcome::Written);
    let written = fs::metadata(inner.join("rover_scl.h")).unwrap().modified().unwrap();
    assert!(is_current(&inner, &file("one")) && !is_current(&inner, &file("two")));
    assert_eq!(write(&inner, &file("one")).unwrap(), Outcome::Unchanged);
    assert_eq!(fs::metadata(inner.join("rover_scl.h")).unwrap().modified().unwrap(), written);
    assert_eq!(write(&inner, &file("two")).unwrap(), Outcome::Written);
    assert_eq!(fs::read_to_string(inner.join("rover_scl.h")).unwrap(), "two");
    assert_eq!(fs::read_dir(&inner).unwrap().count(), 1);
}

/// A compiler that has begun to read goes on with a whole file.
#[test]
fn a_reader_keeps_the_file_that_it_has_opened() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &file("one")).unwrap();
    let mut reader = fs::File::open(folder.path().join("rover_scl.h")).unwrap();
    write(folder.path(), &file("another")).unwrap();
    let mut text = String::new();
    reader.read_to_string(&mut text).unwrap();
    assert_eq!(text, "one");
}

#[test]
fn a_link_stays_and_its_target_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("real.h"), "one").unwrap();
    symlink("real.h", folder.path().join("rover_scl.h")).unwrap();
    write(folder.path(), &file("two")).unwrap();
    assert!(folder.path().join("rover_scl.h").is_symlink());
    assert_eq!(fs::read_to_string(folder.path().join("real.h")).unwrap(), "two");
}

#[test]
fn what_cannot_be_written_is_an_error_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    let error = write(&folder.path().join("file/below"), &file("one")).unwrap_err();
    assert!(matches!(error, OutputError::Folder { .. }), "{error}");
    fs::create_dir(folder.path().join("rover_scl.h")).unwrap();
    let error = write(folder.path(), &file("one")).unwrap_err();
    assert!(matches!(error, OutputError::File { .. }), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn leftovers_of_killed_processes_do_not_disturb() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(".tmpabcdef"), "half").unwrap();
    write(folder.path(), &file("one")).unwrap();
    assert!(is_current(folder.path(), &file("one")));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// As other files that this user creates, not as a temporary one of this user alone.
#[test]
fn a_new_file_has_the_usual_permissions() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &file("one")).unwrap();
    fs::write(folder.path().join("usual"), "").unwrap();
    let mode = |name| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
    assert_eq!(mode("rover_scl.h"), mode("usual"));
}
