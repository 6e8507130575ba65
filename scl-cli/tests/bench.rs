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

/// Figures and ratios are numbers and none is negative.
fn assert_sane(row: &Value) {
    for (name, figure) in row.as_object().unwrap() {
        match name.as_str() {
            "name" => assert!(figure.is_string(), "{row}"),
            "ratios" => {
                let ratios =
                    figure.as_object().unwrap().values().flat_map(|ratios| ratios.as_object().unwrap().values());
                assert!(ratios.map(|ratio| ratio.as_f64().unwrap()).all(|ratio| ratio >= 0.0), "{row}");
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

/// In every table of a report: see [`assert_compared`].
fn assert_compared_everywhere(report: &Value, figure: &str, name: &str, others: &[&str]) {
    for table in report["tables"].as_array().unwrap() {
        assert_compared(table, figure, name, others);
    }
}

/// The row of this name stands beside just these others, with the ratio of this figure to theirs.
fn assert_compared(table: &Value, figure: &str, name: &str, others: &[&str]) {
    let row = |name: &str| table["rows"].as_array().unwrap().iter().find(|row| row["name"] == name).unwrap();
    let mut compared: Vec<&str> = row(name)["ratios"].as_object().unwrap().keys().map(String::as_str).collect();
    let mut expected = others.to_vec();
    compared.sort_unstable();
    expected.sort_unstable();
    assert_eq!(compared, expected, "{name}");
    for other in others {
        let [ours, theirs] = [name, other].map(|name| row(name)[figure].as_f64().unwrap());
        assert!(ours > 0.0 && theirs > 0.0, "{table}");
        // Numbers in JSON may lose their last digit.
        let error = row(name)["ratios"][other][figure].as_f64().unwrap() * theirs / ours - 1.0;
        assert!(error.abs() < 1e-9, "{table}");
    }
}

#[test]
fn round_trips_of_several_lengths() {
    let report = report(&["roundtrip", "--bytes", "20,1024"]);
    let one = [
        "SCL pub/sub",
        "SCL pub/sub blocking",
        "zeromq XPUB/SUB",
        #[cfg(feature = "libzmq")]
        "libzmq XPUB/SUB",
        "SCL req/rep",
        "SCL req/rep blocking",
        "zeromq DEALER/ROUTER",
        #[cfg(feature = "libzmq")]
        "libzmq REQ/REP",
        "Unix socket, tokio",
        "Unix socket, blocking",
    ];
    assert_eq!(names(&report), [one, one].concat());
    for (ours, raw, libzmq) in [
        ("SCL pub/sub", "zeromq XPUB/SUB", "libzmq XPUB/SUB"),
        ("SCL req/rep", "zeromq DEALER/ROUTER", "libzmq REQ/REP"),
    ] {
        let others = if cfg!(feature = "libzmq") { vec![raw, libzmq] } else { vec![raw] };
        assert_compared_everywhere(&report, "p50_us", ours, &others);
        assert_compared_everywhere(&report, "p99_us", &format!("{ours} blocking"), &[others, vec![ours]].concat());
    }
    assert_eq!(report["tables"][1]["title"], "round trip of 1024 bytes between two processes");
}

#[test]
fn rates_of_published_and_pushed_messages() {
    let report = report(&["rate", "--bytes", "20"]);
    let expected = [
        "SCL pub/sub",
        "zeromq XPUB/SUB",
        #[cfg(feature = "libzmq")]
        "libzmq XPUB/SUB",
        "SCL push/pull",
        "zeromq PUSH/PULL",
        #[cfg(feature = "libzmq")]
        "libzmq PUSH/PULL",
        "Unix socket, tokio",
    ];
    assert_eq!(names(&report), expected);
    for (ours, raw, libzmq) in [
        ("SCL pub/sub", "zeromq XPUB/SUB", "libzmq XPUB/SUB"),
        ("SCL push/pull", "zeromq PUSH/PULL", "libzmq PUSH/PULL"),
    ] {
        let others = if cfg!(feature = "libzmq") { vec![raw, libzmq] } else { vec![raw] };
        assert_compared_everywhere(&report, "messages_per_s", ours, &others);
    }
}

#[test]
fn refused_options_say_what_to_write() {
    let (number, seconds) = ("a whole number from", "a time from 0.001 to 3600 seconds, like `5` or `500ms`");
    for (arguments, refused, expected) in [
        (["rate", "--bytes", "20,7"], "7' for '--bytes <BYTES>", format!("{number} 8 to 1048576")),
        (["rate", "--messages", "0"], "0' for '--messages <MESSAGES>", format!("{number} 1 to 10000000")),
        (["roundtrip", "--bytes", "0"], "0' for '--bytes <BYTES>", format!("{number} 1 to 16777216")),
        (["codecs", "--messages", "1e6"], "1e6' for '--messages <MESSAGES>", format!("{number} 1 to 10000000")),
        (["open", "--starts", "99999"], "99999' for '--starts <STARTS>", format!("{number} 1 to 10000")),
        (["delay", "--seconds", "2h"], "2h' for '--seconds <SECONDS>", seconds.to_owned()),
        (["fanout", "--seconds", "0"], "0' for '--seconds <SECONDS>", seconds.to_owned()),
    ] {
        let output = bench(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let errors = String::from_utf8_lossy(&output.stderr);
        let expected = format!("error: invalid value '{refused}': write {expected}");
        assert_eq!(errors.lines().next(), Some(expected.as_str()));
    }
}

#[test]
fn delays_idle_and_under_load() {
    let report = report(&["delay"]);
    let notes = report["notes"].to_string();
    // Without the right to real-time priority a note stands in the place of its rows.
    let refused = notes.contains("real-time priority was not tried") || notes.contains("priority is not permitted");
    let situations = ["idle", "load", "load, real-time"];
    let measured = if refused { &situations[..2] } else { &situations[..] };
    let expected = measured.iter().flat_map(|situation| {
        ["SCL pub/sub", "zeromq XPUB/SUB", "Unix socket, tokio"].map(|way| format!("{way}, {situation}"))
    });
    assert_eq!(names(&report), expected.collect::<Vec<String>>());
    for situation in measured {
        let mut others = vec![format!("zeromq XPUB/SUB, {situation}")];
        if *situation != "idle" {
            others.push("SCL pub/sub, idle".to_owned());
        }
        let others: Vec<&str> = others.iter().map(String::as_str).collect();
        assert_compared_everywhere(&report, "max_us", &format!("SCL pub/sub, {situation}"), &others);
    }
    for row in rows(&report) {
        for figure in ["min_us", "p50_us", "mean_us", "max_us", "variance_us2"] {
            assert!(row[figure].is_f64(), "{figure} of {row}");
        }
    }
}

#[test]
fn delays_while_one_of_eight_is_stopped() {
    let report = report(&["fanout"]);
    let one = ["SCL, all eight run", "SCL, one stopped", "zeromq PUB, all eight run", "zeromq PUB, one stopped"];
    assert_eq!(names(&report), [&one[..], &one[..], &["SCL", "zeromq PUB"]].concat());
    assert_eq!(report["tables"][0]["rows"][0]["lost"], 0.0);
    // Nobody who stood still read anything of its fifty messages, so all of them fit into queue and socket.
    for row in report["tables"][2]["rows"].as_array().unwrap() {
        assert_eq!(row["messages"], 50.0, "{row}");
    }
    let [delays, sends] = [0, 1].map(|table| &report["tables"][table]);
    assert_compared(delays, "p50_us", "SCL, all eight run", &["zeromq PUB, all eight run"]);
    assert_compared(delays, "max_us", "SCL, one stopped", &["SCL, all eight run", "zeromq PUB, one stopped"]);
    assert_compared(sends, "p99_us", "SCL, one stopped", &["SCL, all eight run"]);
    assert_compared(sends, "p99_us", "zeromq PUB, one stopped", &["zeromq PUB, all eight run"]);
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
    assert_compared_everywhere(&report, "encode_ns", "json", &["serde_json alone", "xml"]);
    assert_compared_everywhere(&report, "decode_ns", "postcard", &["xml"]);
}

#[test]
fn the_cost_of_an_open_component() {
    let report = report(&["open"]);
    let expected = ["SCL, 10 gates, alone", "SCL, 10 gates, connected", "10 zeromq sockets", "async runtime only"];
    assert_eq!(names(&report), expected);
    assert_compared_everywhere(&report, "memory_kib", "SCL, 10 gates, alone", &["10 zeromq sockets"]);
    assert_compared_everywhere(&report, "memory_kib", "SCL, 10 gates, connected", &["10 zeromq sockets"]);
}

/// What is printed for people, each line's words with one space between them.
fn lines(arguments: &[&str]) -> Vec<String> {
    let output = bench(arguments);
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn tables_are_for_people() {
    let lines = lines(&["codecs", "--quick"]);
    let expected = [
        "encoding and decoding a record of booleans, integers, strings and floating point numbers",
        "encode ns ratio to decode ns ratio to",
        "encode ns decode ns bytes xml library xml library",
    ];
    assert_eq!(lines[..3], expected);
    assert!(lines[3].starts_with("raw ") && lines[4].starts_with("postcard "), "{lines:?}");
}

#[test]
fn histograms_follow_the_figures() {
    let lines = lines(&["rate", "--bytes", "20", "--quick", "--histogram"]);
    let headings = lines.iter().position(|line| line == "50% 90% 99% 99.9% 99.99% max").unwrap();
    let line = &lines[headings + 1];
    assert!(line.starts_with("SCL pub/sub ") && line.contains('#') && line.ends_with('|'), "{line}");
}

#[test]
fn the_hidden_word_is_not_for_use_by_hand() {
    let output = Command::new(env!("CARGO_BIN_EXE_scl")).args(["bench-other-side", "rover"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let expected = "error: `bench-other-side rover` is not for use by hand: run `scl bench`\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), expected);
}

#[test]
fn a_report_says_where_its_processes_ran() {
    for (cores, expected) in [("any", false), ("one", true)] {
        let output = bench(&["codecs", "--quick", "--json", "--cores", cores]);
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let notes = report["notes"].as_array().unwrap();
        assert_eq!(notes.iter().any(|note| note == "all processes ran on one core"), expected, "{cores}: {notes:?}");
    }
}
