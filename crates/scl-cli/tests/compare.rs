//! `scl compare` on files: what it prints and its exit code. What is equal is tested where it is decided.

use crate::system::System;
use scl_record::testing::{Recorder, Sample};
use std::process::Output;

const SETPOINTS: &str = "/controller/actuator";

const FIRST: [Sample<'_>; 3] = [
    (SETPOINTS, 0, r#"{"throttle": 0.5}"#),
    ("/sensor/measurements", 5, r#"{"speed": 1}"#),
    (SETPOINTS, 10, r#"{"throttle": 0.25}"#),
];

fn system() -> System {
    let system = System::of_files(&[]);
    let second = [FIRST[0], FIRST[1], (SETPOINTS, 12, r#"{"throttle": 0.2500001}"#), (SETPOINTS, 20, "not JSON")];
    for (name, samples) in [("first.mcap", &FIRST[..]), ("second.mcap", &second), ("third.mcap", &second[..3])] {
        Recorder::new().messages(samples).write_to(&system.path(""), name);
    }
    system
}

fn compare(system: &System, arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } = system.scl(&[&["compare"], arguments].concat()).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

#[test]
fn equal_recordings_are_equal() {
    let expected = "controller.actuator: 2 messages equal\nsensor.measurements: 1 message equal\n";
    let equal = (Some(0), expected.to_owned(), String::new());
    assert_eq!(compare(&system(), &["first.mcap", "first.mcap"]), equal);
    assert_eq!(compare(&system(), &["first.mcap", "third.mcap", "--within", "1e-6"]), equal);
    assert_eq!(compare(&system(), &["first.mcap", "third.mcap", "--relative", "1e-6"]), equal);
}

#[test]
fn differences_are_named_and_counted() {
    let (code, text, notes) = compare(&system(), &["first.mcap", "second.mcap"]);
    assert_eq!((code, notes), (Some(1), String::new()));
    assert_eq!(
        text,
        "controller.actuator: 1 of 2 messages different, 0 missing, 1 additional\n  \
         message 1 at 0.010 s, throttle: 0.25 -> 0.2500001\n  \
         message 2 at 0.020 s is additional: 8 bytes: 6e6f74204a534f4e\n\
         sensor.measurements: 1 message equal\n"
    );
    let arguments = ["second.mcap", "first.mcap", "--gate", "controller.actuator", "--show", "1", "--format", "json"];
    let (code, text, _) = compare(&system(), &arguments);
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(code, Some(1));
    assert_eq!(
        report,
        serde_json::json!({"equal": false, "gates": [{
            "gate": "controller.actuator", "equal": false,
            "paired": 2, "different": 1, "missing": 1, "additional": 0,
            "differences": [{
                "kind": "different", "index": 1, "count": 1, "seconds": 0.012, "field": "throttle",
                "first": "0.2500001", "second": "0.25",
            }],
        }]})
    );
}

#[test]
fn what_cannot_be_compared_is_explained() {
    let system = system();
    system.write("empty.mcap", "");
    for (arguments, expected) in [
        (&["first.mcap", "no_such.mcap"][..], "error: there is no file `no_such.mcap`\n"),
        (&["first.mcap", "empty.mcap"], "error: the recording `empty.mcap` is empty\n"),
        (
            &["first.mcap", "first.mcap", "--gate", "controller.actuatr"],
            "= help: did you mean `controller.actuator`?\n",
        ),
        (&["first.mcap", "first.mcap", "--field", "throtle"], "error: no compared message has a field `throtle`\n"),
        (&["first.mcap", "first.mcap", "--field", "a..b"], "is not a field path"),
        (&["first.mcap", "first.mcap", "--within", "-1"], "expected a number of at least 0, like `1e-6`"),
    ] {
        let (code, text, error) = compare(&system, arguments);
        assert_eq!((code, text), (Some(2), String::new()), "{arguments:?}");
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
}
