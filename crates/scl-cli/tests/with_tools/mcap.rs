//! Python's `mcap` reads our files, with and without the index, and counts what was sent.

#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../record/recorder.rs"]
mod recorder;
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../record/source.rs"]
mod source;

use recorder::sequences;
use scl_tests::{python_with_packages, wait_until};
use serde_json::{Value, json};
use source::Source;
use std::path::Path;
use std::process::Command;

const COUNT: u64 = 500;
const GATES: [&str; 3] = ["measurements", "position", "g0"];

fn read_with_python(file: &Path) -> Value {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/record/read_mcap.py");
    let output = Command::new(python_with_packages()).arg(script).arg(file).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn send(source: &mut Source) {
    for number in 0..COUNT {
        let speed = number as f64 / 2.0;
        source.send("measurements", &[&[0x09][..], &speed.to_le_bytes()].concat());
        source.send("position", format!(r#"{{"latitude": {speed:?}}}"#).as_bytes());
        source.send("g0", &[7]);
    }
}

/// Compares what Python has read with what was sent: all messages after the first that the recorder saw.
fn check(source: &Source, read: &Value, complete: bool) {
    let sum = (0..COUNT).map(|number| number as f64 / 2.0).sum::<f64>();
    let expected = |gate: &str, encoding: &str, name: &str, schema: &str, sum: Option<f64>| {
        let (first, sent) = (read["stream"][format!("/source/{gate}")]["first"].as_u64().unwrap(), source.sent(gate));
        assert!(sent - first >= COUNT);
        json!({
            "count": sent - first, "first": first, "last": sent - 1,
            "encoding": encoding, "schema": name, "schema_encoding": schema, "sum": sum,
        })
    };
    let topics = json!({
        "/source/g0": expected("g0", "raw", "bytes", "", None),
        "/source/measurements": expected("measurements", "protobuf", "rover.Measurement", "protobuf", Some(sum)),
        "/source/position": expected("position", "json", "rover.Position", "jsonschema", Some(sum)),
    });
    let indexed = if complete { topics.clone() } else { Value::Null };
    assert_eq!(*read, json!({"stream": topics, "complete": complete, "indexed": indexed}));
}

#[test]
fn python_reads_a_recording_with_and_without_its_index() {
    let mut source = Source::start();
    let recorder = source.record(&GATES, &[]);
    send(&mut source);
    recorder.stop();
    check(&source, &read_with_python(&source.rover.path("flight.mcap")), true);
}

#[test]
fn python_reads_the_recording_of_a_killed_recorder() {
    let mut source = Source::start();
    let recorder = source.record(&GATES, &[]);
    send(&mut source);
    let file = source.rover.path("flight.mcap");
    let is_flushed =
        |gate: &&str| sequences(&file, &format!("/source/{gate}"), 0).last() == Some(&(source.sent(gate) - 1));
    wait_until("everything is flushed", || GATES.iter().all(is_flushed));
    recorder.signal("-KILL");
    recorder.finish();
    check(&source, &read_with_python(&file), false);
    source.rover.text(&["recover", "flight.mcap"]);
    check(&source, &read_with_python(&file), true);
}
