//! Files that earlier releases wrote, kept as they were: today's tools read them. `docs/compatibility.md` has the
//! promise.
//!
//! A folder of `tests/kept` has what one release wrote for the quick start: a recording, and the files of a controller
//! that was killed. A change of a format adds a folder and changes none.

use crate::system::System;
use serde_json::{Value, json};
use std::fs::{self, DirBuilder, Permissions};
use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
use std::path::{Path, PathBuf};

#[test]
fn figures_and_announcements_of_earlier_releases_are_shown() {
    for release in releases() {
        let system = System::of_files(&[]);
        let folder = system.path("runtime/rover");
        DirBuilder::new().recursive(true).mode(0o700).create(&folder).unwrap();
        for entry in fs::read_dir(&release).unwrap().flatten() {
            let copy = folder.join(entry.file_name());
            fs::copy(entry.path(), &copy).unwrap();
            fs::set_permissions(&copy, Permissions::from_mode(0o600)).unwrap();
        }
        let found = info(&system, "controller.sensor");
        let expected = json!({"messages": 35, "bytes": 315, "lost": 0, "peers": 1});
        for (figure, value) in expected.as_object().unwrap() {
            assert_eq!(&found["figures"][figure], value, "{}: {figure}: {found}", release.display());
        }
        assert_eq!((&found["component"]["state"], &found["contract"]), (&json!("dead"), &json!("hl75aqsl")));
        assert_eq!(found["peers"][0]["name"], "sensor.measurements");
        assert_eq!(info(&system, "controller.commands")["peers"][0]["figures"]["taken"], 3);
    }
}

#[test]
fn recordings_of_earlier_releases_are_read() {
    for release in releases() {
        let (system, recording) = (System::of_files(&[]), release.join("flight.mcap"));
        let recording = recording.to_str().unwrap();
        let compared = system.scl(&["compare", recording, recording]).output().unwrap();
        let expected = "controller.actuator: 20 messages equal\n\
            controller.commands request: 2 messages equal\n\
            controller.commands reply: 2 messages equal\n\
            controller.events: 2 messages equal\n\
            sensor.measurements: 20 messages equal\n";
        assert_eq!(String::from_utf8_lossy(&compared.stdout), expected, "{recording}: {compared:?}");
        // The sensor is opened from the plan in the recording.
        let replay = ["replay", recording, "--as", "sensor", "--ready", "0s", "--rate", "max"];
        let replayed = system.scl(&replay).env("SCL_RUNTIME_DIR", system.path("runtime")).output().unwrap();
        assert_eq!(replayed.status.code(), Some(0), "{recording}: {replayed:?}");
    }
}

/// The folders of `tests/kept`.
fn releases() -> Vec<PathBuf> {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/kept");
    let releases: Vec<_> = fs::read_dir(kept).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(!releases.is_empty());
    releases
}

fn info(system: &System, gate: &str) -> Value {
    let mut command = system.scl(&["info", gate, "--system", "rover", "--format", "json"]);
    let output = command.env("SCL_RUNTIME_DIR", system.path("runtime")).output().unwrap();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}
