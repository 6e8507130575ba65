//! `scl info FILE`: what is in a recording.

use crate::system::System;
use expect_test::expect;
use scl_plan::SystemPlan;
use scl_record::format::{GateTotals, Totals};
use scl_record::testing::{Recorder, Sample};
use std::collections::BTreeMap;

const SAMPLES: [Sample<'_>; 5] = [
    ("/sensor/measurements", 0, r#"{"speed":1}"#),
    ("/sensor/measurements", 250, r#"{"speed":2}"#),
    ("/controller/commands/request", 400, "{}"),
    ("/controller/commands/reply", 1500, "null"),
    // The clock was set forward.
    ("/sensor/measurements", 7_200_500, r#"{"speed":3}"#),
];

fn system() -> System {
    let system = System::of_files(&[]);
    let gates = BTreeMap::from([("sensor.measurements".to_owned(), GateTotals { recorded: 2, lost: 3, latched: 0 })]);
    let totals = Totals { system: "rover".to_owned(), gates };
    let plan = SystemPlan { system: "rover".to_owned(), components: Vec::new(), kinds: Vec::new() };
    Recorder::new()
        .attach_plan(&plan)
        .messages(&SAMPLES)
        .other_message(("/tf", "cdr", "ros2msg"), b"1234")
        .totals(&totals)
        .write_to(&system.path(""), "flight.mcap");
    system
}

#[test]
fn a_recording_is_described() {
    let output = system().scl(&["info", "flight.mcap"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    expect![[r#"
        note: the recorder lost 3 messages of `sensor.measurements`
        note: `/tf` was not recorded by SCL: it is not `/<component>/<gate>`; messages left out: 1
        note: nothing was recorded for 7199.0 s from 1.5 s on, or the clock was set forward
    "#]]
    .assert_eq(&String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let (file, text) = text.split_once('\n').unwrap();
    assert!(file.starts_with("  file         flight.mcap, ") && file.ends_with('B'), "{file}");
    expect![[r#"
          recorded     2023-11-14T22:13:20.000Z, for 7200.5 s
          system       rover
          attachments  plan.json
        GATE                         KIND  TYPE               CODEC  MESSAGES  BYTES  LOST
        controller.commands request  rep   rover.Measurement  json          1    2 B     ?
        controller.commands reply    rep   rover.Measurement  json          1    4 B     ?
        sensor.measurements          pub   rover.Measurement  json          3   33 B     3
        NOT RECORDED BY SCL  ENCODING  SCHEMA      MESSAGES
        /tf                  cdr       other/Type         1
    "#]]
    .assert_eq(text);
}

#[test]
fn a_recording_is_described_in_json() {
    let output = system().scl(&["info", "./flight.mcap", "--format", "json"]).output().unwrap();
    let mut info: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(info["files"][0]["bytes"].take().as_u64().unwrap() > 500);
    let gate = |gate: &str, kind: &str, messages: u64, bytes: u64, lost: Option<u64>| {
        serde_json::json!({
            "gate": gate, "kind": kind, "type": "rover.Measurement", "codec": "json", "contract": "aaaaaaaa",
            "peers": [], "messages": messages, "bytes": bytes, "lost": lost,
        })
    };
    let expected = serde_json::json!({
        "files": [{"path": "./flight.mcap", "bytes": null}],
        "recorded": "2023-11-14T22:13:20.000Z",
        "seconds": 7200.5,
        "system": "rover",
        "attachments": ["plan.json"],
        "parameters": {},
        "missed": [],
        "gates": [
            gate("controller.commands request", "rep", 1, 2, None),
            gate("controller.commands reply", "rep", 1, 4, None),
            gate("sensor.measurements", "pub", 3, 33, Some(3)),
        ],
        "others": [{
            "topic": "/tf", "encoding": "cdr", "schema": "other/Type", "messages": 1,
            "reason": "it is not `/<component>/<gate>`",
        }],
        "notes": [
            "the recorder lost 3 messages of `sensor.measurements`",
            "`/tf` was not recorded by SCL: it is not `/<component>/<gate>`; messages left out: 1",
            "nothing was recorded for 7199.0 s from 1.5 s on, or the clock was set forward",
        ],
    });
    assert_eq!(info, expected);
}

#[test]
fn a_file_that_is_missing_is_named() {
    let output = system().scl(&["info", "flights.mcap"]).output().unwrap();
    let error = "error: there is no file `flights.mcap`\n  = help: name a file written by `scl record`\n";
    assert_eq!((output.status.code(), &*String::from_utf8_lossy(&output.stderr)), (Some(2), error));
}
