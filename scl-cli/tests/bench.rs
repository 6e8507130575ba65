//! `scl bench`: every scenario runs for next to nothing and prints figures that programs can read. No figure is judged.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use serde_json::Value;
use std::process::{Command, Output};

fn bench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_scl")).arg("bench").args(arguments).output().unwrap()
}

/// Runs a scenario for next to nothing; its report, after the checks that hold for all of them.
fn report(arguments: &[&str]) -> Value {
    let output = bench(&[arguments, &["--json", "--quick"]].concat());
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    assert_eq!(errors, "");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["scenario"], arguments[0]);
    for row in rows(&report) {
        assert_sane(row);
    }
    report
}

fn rows(report: &Value) -> impl Iterator<Item = &Value> {
    report["tables"].as_array().unwrap().iter().flat_map(|table| table["rows"].as_array().unwrap())
}

/// Figures and ratios are numbers and none is negative; what a row stands beside is there.
fn assert_sane(row: &Value) {
    for (name, figure) in row.as_object().unwrap() {
        match name.as_str() {
            "name" | "beside" => assert!(figure.is_string(), "{row}"),
            "ratios" => {
                assert!(figure.as_object().unwrap().values().all(|ratio| ratio.as_f64().unwrap() > 0.0), "{row}")
            }
            "distribution" => assert_rises(figure),
            _ => assert!(figure.as_f64().unwrap() >= 0.0, "{name} of {row}"),
        }
    }
}

/// A greater part of all times is reached no sooner than a smaller one.
fn assert_rises(distribution: &Value) {
    let steps: Vec<(f64, f64)> = serde_json::from_value(distribution.clone()).unwrap();
    assert!(!steps.is_empty() && steps.is_sorted_by(|a, b| a.0 <= b.0 && a.1 <= b.1), "{steps:?}");
}

fn names(report: &Value) -> Vec<&str> {
    rows(report).map(|row| row["name"].as_str().unwrap()).collect()
}

/// The rows named so have this figure, above zero, and its ratio to the row beside.
fn assert_compared(report: &Value, figure: &str, names: &[&str]) {
    for row in rows(report).filter(|row| names.contains(&row["name"].as_str().unwrap())) {
        assert!(row[figure].as_f64().unwrap() > 0.0, "{row}");
        assert!(row["ratios"][figure].as_f64().unwrap() > 0.0, "{row}");
    }
}

#[test]
fn round_trips_of_several_lengths() {
    let report = report(&["roundtrip", "--bytes", "20,1024"]);
    let one = [
        "SCL pub/sub",
        "SCL pub/sub blocking",
        "zeromq XPUB/SUB",
        "SCL req/rep",
        "SCL req/rep blocking",
        "zeromq DEALER/ROUTER",
        #[cfg(feature = "libzmq")]
        "libzmq XPUB/SUB",
        #[cfg(feature = "libzmq")]
        "libzmq REQ/REP",
        "Unix socket, tokio",
        "Unix socket, blocking",
    ];
    assert_eq!(names(&report), [one, one].concat());
    assert_compared(&report, "p50_us", &["SCL pub/sub", "SCL pub/sub blocking", "SCL req/rep", "SCL req/rep blocking"]);
    assert_eq!(report["tables"][1]["title"], "round trip of 1024 bytes between two processes");
}

#[test]
fn rates_of_published_and_pushed_messages() {
    let report = report(&["rate", "--bytes", "20"]);
    let expected = ["SCL pub/sub", "zeromq XPUB/SUB", "SCL push/pull", "zeromq PUSH/PULL", "Unix socket, tokio"];
    assert_eq!(names(&report), expected);
    assert_compared(&report, "messages_per_s", &["SCL pub/sub", "SCL push/pull"]);
}

#[test]
fn a_message_too_short_for_its_time_is_refused() {
    let output = bench(&["rate", "--bytes", "20,7"]);
    assert_eq!(output.status.code(), Some(2));
    let expected = "error: messages of 7 bytes are too short: each carries its time, 8 bytes\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), expected);
}

#[test]
fn delays_idle_and_under_load() {
    let report = report(&["delay"]);
    let tables = report["tables"].as_array().unwrap();
    for (table, situation) in tables.iter().zip(["idle", "under load", "under load, real-time priority"]) {
        let expected = format!("delay of 20 bytes at 1000 Hz between two processes, {situation}");
        assert_eq!(table["title"], expected.as_str());
    }
    // Without the right to it there is a note in the place of the third table.
    let refused = report["notes"].to_string().contains("real-time priority was not tried")
        || report["notes"].to_string().contains("real-time priority is not permitted");
    assert_eq!(tables.len(), if refused { 2 } else { 3 });
    assert_compared(&report, "max_us", &["SCL pub/sub"]);
}

#[test]
fn codecs_and_xml() {
    let report = report(&["codecs"]);
    let expected = ["raw", "postcard", "protobuf", "prost alone", "msgpack", "cbor", "json", "serde_json alone", "xml"];
    assert_eq!(names(&report), expected);
    let bytes = |name: &str| rows(&report).find(|row| row["name"] == name).unwrap()["bytes"].as_f64().unwrap();
    assert_eq!(bytes("protobuf"), bytes("prost alone"));
    assert_eq!(bytes("json"), bytes("serde_json alone"));
    assert!(bytes("postcard") < bytes("json") && bytes("json") < bytes("xml"));
}

#[test]
fn the_cost_of_an_open_component() {
    let report = report(&["open"]);
    let expected = [
        "SCL, 10 gates, alone",
        "SCL, 10 gates, connected",
        "10 zeromq sockets, 5 of them bound",
        "async runtime only",
    ];
    assert_eq!(names(&report), expected);
    assert_compared(&report, "memory_kib", &["SCL, 10 gates, alone", "SCL, 10 gates, connected"]);
}

#[test]
fn tables_are_for_people() {
    let output = bench(&["codecs", "--quick"]);
    let text = String::from_utf8_lossy(&output.stdout);
    let mut lines = text.lines();
    let title = "encoding and decoding a record of booleans, integers, strings and floating point numbers";
    assert_eq!(lines.next(), Some(title));
    let headings = lines.next().unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(headings, "encode ns decode ns bytes encode ns ratio decode ns ratio");
}

#[test]
fn the_hidden_word_is_not_for_use_by_hand() {
    let output = Command::new(env!("CARGO_BIN_EXE_scl")).args(["bench-other-side", "rover"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let expected = "error: `bench-other-side rover` is not for use by hand: run `scl bench`\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), expected);
}
