//! What the file of `--topics` says, and what is wrong with it. With a client: `foxglove` among the tests of `scl-cli`.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::net::TcpListener;
use std::process::Command;

/// Standard error for a file that is refused.
#[track_caller]
fn refused(topics: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("panels.yaml"), topics).unwrap();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_scl-foxglove"));
    command.args(["--topics", "panels.yaml", "--system", "rover", "--port"]).current_dir(folder.path());
    // It cannot listen, either, so that it ends in any case.
    command.arg(taken.local_addr().unwrap().port().to_string());
    let output = command.env("SCL_RUNTIME_DIR", folder.path()).output().unwrap();
    assert_eq!((output.status.code(), &*output.stdout), (Some(2), &b""[..]), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// A file with one topic, which has these lines.
fn topic(lines: &str) -> String {
    format!("/rover/place:\n{}", lines.lines().map(|line| format!("  {line}\n")).collect::<String>())
}

#[test]
fn a_file_of_topics_is_checked_before_anything_starts() {
    let sound = "from: /sensor/position\nschema: foxglove.LocationFix\nmessage: {latitude: =latitude}\n";
    for (file, expected) in [
        ("[1, 2]".to_owned(), "expected topics, each with `from`, `schema` and `message`"),
        ("/rover/place: {from: [".to_owned(), "panels.yaml"),
        ("rover: {}".to_owned(), "the name of a topic begins with `/`"),
        (topic("x"), "expected `from`, `schema` and `message`"),
        (topic(&sound.replace("from:", "form:")), "did you mean `from`?"),
        (topic(&sound.replace("from: /sensor/position\n", "")), "`from` is missing"),
        (topic(&sound.replace("/sensor/position", "[1]")), "`from` is not a text"),
        (topic(&sound.replace("/sensor/position", "sensor.position")), "name it as recordings do: `/component/gate`"),
        (topic(&sound.replace("LocationFix", "LocationFx")), "did you mean `foxglove.LocationFix`?"),
        (topic(&sound.replace("{latitude:", "{latitud:")), "did you mean `latitude`?"),
        (topic(&sound.replace("=latitude", "=a..b")), "is not a field path"),
        (topic(&sound.replace("=latitude", "=quaternion(a")), "is not a field path"),
        (format!("{0}{0}", topic(sound)), "topic `/rover/place` is there twice"),
    ] {
        let error = refused(&file);
        assert!(error.contains(expected) && error.contains("panels.yaml"), "{file}\n{error}");
    }
    let error = refused_missing();
    assert!(error.contains("panels.yaml") && error.contains("No such file"), "{error}");
}

fn refused_missing() -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_scl-foxglove")).args(["--topics", "/nowhere/panels.yaml"]).output();
    String::from_utf8(output.unwrap().stderr).unwrap()
}
