//! A disk that is full, played by a limit on the size of files, which needs no rights.

use super::recorder::{Recorder, messages, summary};
use super::source::Source;
use std::process::Command;

/// `scl record` below `ulimit -f`, in blocks of 512 bytes. The shell ignores SIGXFSZ, and so do its children, so that a
/// write fails as on a full disk.
fn limited(source: &Source, blocks: u32, arguments: &[&str]) -> Command {
    let scl = source.rover.scl(&[]);
    let mut command = Command::new("sh");
    command.args(["-c", &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" record \"$@\"")]);
    command.arg(scl.get_program()).args(arguments).current_dir(source.rover.path(""));
    scl.get_envs().for_each(|(name, value)| match value {
        Some(value) => drop(command.env(name, value)),
        None => drop(command.env_remove(name)),
    });
    command
}

#[test]
fn a_full_disk_ends_the_recording_with_a_complete_file() {
    let mut source = Source::start();
    // 512 KiB.
    let mut recorder = Recorder::spawn(limited(&source, 1024, &["source.g0", "-o", "flight.mcap"]));
    recorder.wait_for("connected to 1 gates");
    // Incompressible, and more than there is room for.
    let mut state = 1_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state.to_le_bytes()
    };
    // The first ones may be sent before the gate knows the recorder.
    for _ in 0..200 {
        let payload: Vec<u8> = (0..2048).flat_map(|_| random()).collect();
        source.send("g0", &payload);
    }
    let (code, out, err) = recorder.finish();
    assert_eq!(code, Some(1), "{err}");
    let expected =
        "error: recording stopped: the file has reached the largest allowed size (`ulimit -f`)\n --> flight.mcap\n";
    assert_eq!(err, expected);

    let file = source.rover.path("flight.mcap");
    let kept = messages(&file).len();
    assert!(kept > 5, "{kept}");
    assert_eq!(summary(&file).stats.unwrap().message_count, kept as u64);
    assert!(std::fs::metadata(&file).unwrap().len() <= 512 << 10);
    assert!(out.contains(&format!("{kept}")), "{out}");
}

#[test]
fn a_disk_without_any_room_is_reported_at_once() {
    let source = Source::start();
    let recorder = Recorder::spawn(limited(&source, 8, &["-o", "flight.mcap"]));
    let (code, out, err) = recorder.finish();
    assert_eq!((code, out.as_str()), (Some(2), ""), "{err}");
    assert!(err.starts_with("error: recording stopped: the file has reached the largest"), "{err}");
    assert!(!source.rover.path("flight.mcap").exists());
}

#[test]
fn a_device_without_room_fails_like_a_full_disk() {
    let source = Source::start();
    let error = source.rover.error(&["record", "-o", "/dev/full", "--overwrite"], 2);
    assert!(error.contains("/dev/full"), "{error}");
}
