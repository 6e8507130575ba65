//! Python's `mcap` reads our files, with and without the index, and counts what was sent.

use super::recorder::{Recorder, messages};
use super::source::Source;
use scl_tests::{python_with_packages, wait_until};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;

const COUNT: u64 = 500;

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

fn expected(complete: bool) -> Value {
    let topic = |encoding: &str, name: &str, schema: &str, sum: Option<f64>| json!({"count": COUNT, "encoding": encoding, "schema": name, "schema_encoding": schema, "sum": sum});
    let sum = (0..COUNT).map(|number| number as f64 / 2.0).sum();
    let topics = json!({
        "/source/g0": topic("raw", "bytes", "", None),
        "/source/measurements": topic("protobuf", "rover.Measurement", "protobuf", Some(sum)),
        "/source/position": topic("json", "rover.Position", "jsonschema", Some(sum)),
    });
    json!({"stream": topics, "complete": complete, "indexed": if complete { topics.clone() } else { Value::Null }})
}

#[test]
fn python_reads_a_recording_with_and_without_its_index() {
    let mut source = Source::start();
    let gates = ["source.measurements", "source.position", "source.g0"];
    let recorder = Recorder::start(&source.rover, 3, &gates);
    send(&mut source);
    recorder.stop();
    assert_eq!(read_with_python(&source.rover.path("flight.mcap")), expected(true));
}

#[test]
fn python_reads_the_recording_of_a_killed_recorder() {
    let mut source = Source::start();
    let gates = ["source.measurements", "source.position", "source.g0"];
    let recorder = Recorder::start(&source.rover, 3, &gates);
    send(&mut source);
    let file = source.rover.path("flight.mcap");
    wait_until("everything is flushed", || messages(&file).len() as u64 == 3 * COUNT);
    recorder.signal("-KILL");
    recorder.finish();
    assert_eq!(read_with_python(&file), expected(false));
    source.rover.text(&["recover", "flight.mcap"]);
    assert_eq!(read_with_python(&file), expected(true));
}
