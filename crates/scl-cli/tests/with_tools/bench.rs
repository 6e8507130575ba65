//! `scl bench`: every benchmark runs for next to nothing and prints values that programs can read. No value is judged.

use serde_json::Value;
use std::process::{Command, Output};

fn bench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_scl")).arg("bench").args(arguments).output().unwrap()
}

/// Runs a benchmark for next to nothing, and returns its report after the checks that hold for all reports.
fn report(arguments: &[&str]) -> Value {
    let output = bench(&[arguments, &["--json", "--quick"]].concat());
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    assert_eq!(errors, "");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["benchmark"], arguments[0]);
    for row in rows(&report) {
        assert_sane(row);
    }
    report
}

fn rows(report: &Value) -> impl Iterator<Item = &Value> {
    report["tables"].as_array().unwrap().iter().flat_map(|table| table["rows"].as_array().unwrap())
}

/// Values and ratios are numbers and not negative.
fn assert_sane(row: &Value) {
    for (name, value) in row.as_object().unwrap() {
        match name.as_str() {
            "name" => assert!(value.is_string(), "{row}"),
            "ratios" => value.as_object().unwrap().values().for_each(assert_sane_ratios),
            "distribution" => assert_rises(value),
            _ => assert!(value.as_f64().unwrap() >= 0.0, "{name} of {row}"),
        }
    }
}

/// Ratios are between their quartiles.
fn assert_sane_ratios(ratios: &Value) {
    for (name, ratio) in ratios.as_object().unwrap().iter().filter(|(name, _)| !name.ends_with("_quartiles")) {
        let ratio = ratio.as_f64().unwrap();
        assert!(ratio >= 0.0, "{ratios}");
        if let Some(quartiles) = ratios.get(format!("{name}_quartiles")) {
            let [first, third]: [f64; 2] = serde_json::from_value(quartiles.clone()).unwrap();
            assert!((first..=third).contains(&ratio), "{ratios}");
        }
    }
}

/// A larger fraction of all durations does not have a smaller quantile.
fn assert_rises(distribution: &Value) {
    let steps: Vec<(f64, f64)> = serde_json::from_value(distribution.clone()).unwrap();
    assert!(!steps.is_empty() && steps.is_sorted_by(|a, b| a.0 <= b.0 && a.1 <= b.1), "{steps:?}");
}

fn names(report: &Value) -> Vec<&str> {
    rows(report).map(|row| row["name"].as_str().unwrap()).collect()
}

fn row<'a>(table: &'a Value, name: &str) -> &'a Value {
    table["rows"].as_array().unwrap().iter().find(|row| row["name"] == name).unwrap()
}

/// In every table: see [`assert_compared`].
fn assert_compared_everywhere(report: &Value, value: &str, name: &str, baselines: &[&str]) {
    for table in report["tables"].as_array().unwrap() {
        assert_compared(table, value, name, baselines);
    }
}

/// A row is compared with exactly these baselines, by this value.
fn assert_compared(table: &Value, value: &str, name: &str, baselines: &[&str]) {
    let ratios = row(table, name)["ratios"].as_object().unwrap();
    let mut compared: Vec<&str> = ratios.keys().map(String::as_str).collect();
    let mut expected = baselines.to_vec();
    compared.sort_unstable();
    expected.sort_unstable();
    assert_eq!(compared, expected, "{name}");
    for baseline in baselines {
        let [ours, theirs] = [name, baseline].map(|name| row(table, name)[value].as_f64().unwrap());
        assert!(ours > 0.0 && theirs > 0.0, "{table}");
        let ratio = ratios[*baseline][value].as_f64().unwrap();
        // A ratio that comes from several rounds is not the ratio of the values.
        if ratios[*baseline].get(format!("{value}_quartiles")).is_none() {
            assert!((ratio * theirs / ours - 1.0).abs() < 1e-9, "{table}");
        }
    }
}

#[test]
fn roundtrip_has_one_table_per_size() {
    let report = report(&["roundtrip", "--bytes", "20,1024"]);
    let table = [
        "SCL pub/sub",
        "SCL req/rep",
        "zeromq XPUB/SUB",
        "zeromq DEALER/ROUTER",
        "Unix socket (tokio)",
        "SCL pub/sub (blocking)",
        "SCL req/rep (blocking)",
        #[cfg(feature = "libzmq")]
        "libzmq XPUB/SUB",
        #[cfg(feature = "libzmq")]
        "libzmq REQ/REP",
        "Unix socket (blocking)",
    ];
    assert_eq!(names(&report), [table, table].concat());
    for (ours, zeromq, libzmq) in [
        ("SCL pub/sub", "zeromq XPUB/SUB", "libzmq XPUB/SUB"),
        ("SCL req/rep", "zeromq DEALER/ROUTER", "libzmq REQ/REP"),
    ] {
        let libzmq = if cfg!(feature = "libzmq") { vec![libzmq] } else { vec![] };
        let baselines = [&["Unix socket (tokio)", zeromq], &libzmq[..]].concat();
        assert_compared_everywhere(&report, "p50_us", ours, &baselines);
        let baselines = [&["Unix socket (blocking)", ours], &libzmq[..]].concat();
        assert_compared_everywhere(&report, "p99_us", &format!("{ours} (blocking)"), &baselines);
    }
    assert_eq!(report["tables"][1]["title"], "round trip of 1024 bytes between two processes");
}

#[test]
fn rate_compares_pub_and_push() {
    let report = report(&["rate", "--bytes", "20"]);
    let expected = [
        "SCL pub/sub",
        "SCL pub/sub (blocking)",
        "zeromq XPUB/SUB",
        #[cfg(feature = "libzmq")]
        "libzmq XPUB_NODROP",
        #[cfg(feature = "libzmq")]
        "libzmq XPUB (no limit)",
        "SCL push/pull",
        "SCL push/pull (blocking)",
        "zeromq PUSH/PULL",
        #[cfg(feature = "libzmq")]
        "libzmq PUSH",
        #[cfg(feature = "libzmq")]
        "libzmq PUSH (no limit)",
        "Unix socket (tokio)",
    ];
    assert_eq!(names(&report), expected);
    for (ours, zeromq, libzmq) in [
        ("SCL pub/sub", "zeromq XPUB/SUB", ["libzmq XPUB_NODROP", "libzmq XPUB (no limit)"]),
        ("SCL push/pull", "zeromq PUSH/PULL", ["libzmq PUSH", "libzmq PUSH (no limit)"]),
    ] {
        let libzmq = if cfg!(feature = "libzmq") { &libzmq[..] } else { &[] };
        let baselines = [&[zeromq], libzmq].concat();
        assert_compared_everywhere(&report, "messages_per_s", ours, &baselines);
        assert_compared_everywhere(&report, "messages_per_s", &format!("{ours} (blocking)"), &baselines);
    }
}

#[test]
fn fresh_measures_every_call() {
    let report = report(&["fresh"]);
    let expected = [
        "SCL recv",
        "SCL recv (polled)",
        "SCL recv_blocking",
        "SCL latest",
        #[cfg(feature = "libzmq")]
        "libzmq SUB (ZMQ_CONFLATE)",
        "zeromq SUB",
    ];
    assert_eq!(names(&report), expected);
    let baselines = &expected[4..];
    for ours in &expected[..4] {
        assert_compared_everywhere(&report, "age_p50_periods", ours, baselines);
    }
}

#[test]
fn restart_measures_every_role() {
    let report = report(&["restart"]);
    let scl = ["SCL pub", "SCL sub", "SCL push", "SCL pull", "SCL req", "SCL rep"];
    let others = [
        #[cfg(feature = "libzmq")]
        "libzmq PUB",
        #[cfg(feature = "libzmq")]
        "libzmq SUB",
        "zeromq SUB",
        "Unix socket, connecting side",
    ];
    assert_eq!(names(&report), [&scl[..], &others].concat());
    for ours in scl {
        assert_compared_everywhere(&report, "max_ms", ours, &["Unix socket, connecting side"]);
    }
}

/// Without the feature of a transport, the command says how to build it.
#[cfg(not(all(feature = "shm", feature = "gateway")))]
#[test]
fn transports_that_are_not_built_in_name_their_feature() {
    for (arguments, feature, is_built_in) in [
        (&["roundtrip", "--transport", "shm"][..], "shm", cfg!(feature = "shm")),
        (&["rate", "--transport", "shm"], "shm", cfg!(feature = "shm")),
        (&["roundtrip", "--transport", "gateway"], "gateway", cfg!(feature = "gateway")),
        (&["rate", "--transport", "gateway"], "gateway", cfg!(feature = "gateway")),
        (&["gateway-growth"], "gateway", cfg!(feature = "gateway")),
    ] {
        if is_built_in {
            continue;
        }
        let output = bench(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let expected = format!(
            "error: this `scl` was built without the transport `{feature}`; \
             build it with `cargo build --release -p scl-cli --features {feature}`\n"
        );
        assert_eq!(String::from_utf8_lossy(&output.stderr), expected, "{arguments:?}");
    }
}

#[cfg(feature = "shm")]
#[test]
fn shared_memory_is_compared_with_iceoryx2() {
    for (benchmark, value) in [("roundtrip", "p50_us"), ("rate", "messages_per_s")] {
        let report = report(&[benchmark, "--transport", "shm", "--bytes", "1024,1048576"]);
        for (name, baselines) in [
            ("SCL shm, loaned", ["iceoryx2, loaned", "SCL ipc"]),
            ("SCL shm, loaned (blocking)", ["iceoryx2, loaned", "SCL ipc (blocking)"]),
            ("SCL shm, copied", ["iceoryx2, copied", "SCL ipc"]),
            ("SCL shm, copied (blocking)", ["iceoryx2, copied", "SCL ipc (blocking)"]),
        ] {
            assert_compared_everywhere(&report, value, name, &baselines);
        }
    }
    let output = bench(&["roundtrip", "--transport", "shm", "--bytes", "4194305"]);
    let expected = "error: a message has 1 to 4194304 bytes, not 4194305\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), expected);
}

#[test]
fn errors_say_what_an_option_accepts() {
    let (number, seconds) = ("a whole number from", "a time from 0.001 to 3600 seconds, like `5` or `500ms`");
    for (arguments, rejected, expected) in [
        (["rate", "--bytes", "20,7"], "7' for '--bytes <BYTES>", format!("{number} 8 to 4194304")),
        (["rate", "--messages", "0"], "0' for '--messages <MESSAGES>", format!("{number} 1 to 10000000")),
        (["roundtrip", "--bytes", "0"], "0' for '--bytes <BYTES>", format!("{number} 1 to 16777216")),
        (["fresh", "--repetitions", "0"], "0' for '--repetitions <REPETITIONS>", format!("{number} 1 to 10000")),
        (["fresh", "--pause", "1ns"], "1ns' for '--pause <PAUSE>", seconds.to_owned()),
        (["restart", "--restarts", "-1"], "-1' for '--restarts <RESTARTS>", format!("{number} 1 to 10000")),
        (["codecs", "--messages", "1e6"], "1e6' for '--messages <MESSAGES>", format!("{number} 1 to 10000000")),
        (["delay", "--seconds", "2h"], "2h' for '--seconds <SECONDS>", seconds.to_owned()),
        (["fanout", "--seconds", "0"], "0' for '--seconds <SECONDS>", seconds.to_owned()),
    ] {
        let [benchmark, option, value] = arguments;
        let output = bench(&[benchmark, &format!("{option}={value}")]);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let errors = String::from_utf8_lossy(&output.stderr);
        let expected = format!("error: invalid value '{rejected}': write {expected}");
        assert_eq!(errors.lines().next(), Some(expected.as_str()));
    }
}

#[test]
fn delay_is_measured_idle_and_under_load() {
    let report = report(&["delay"]);
    let notes = report["notes"].to_string();
    // Without permission for real-time priority, a note replaces its rows.
    let is_refused = notes.contains("real-time priority was not measured") || notes.contains("is not permitted");
    let situations = ["idle", "load", "real-time"];
    let measured = if is_refused { &situations[..2] } else { &situations[..] };
    let expected = measured.iter().flat_map(|situation| {
        ["SCL pub/sub", "zeromq XPUB/SUB", "Unix socket (tokio)"].map(|variant| format!("{variant}, {situation}"))
    });
    assert_eq!(names(&report), expected.collect::<Vec<String>>());
    for situation in measured {
        let mut baselines = vec![format!("zeromq XPUB/SUB, {situation}"), format!("Unix socket (tokio), {situation}")];
        if *situation != "idle" {
            baselines.push("SCL pub/sub, idle".to_owned());
        }
        let baselines: Vec<&str> = baselines.iter().map(String::as_str).collect();
        assert_compared_everywhere(&report, "max_us", &format!("SCL pub/sub, {situation}"), &baselines);
    }
    for row in rows(&report) {
        for value in ["min_us", "p50_us", "mean_us", "max_us", "variance_us2"] {
            assert!(row[value].is_f64(), "{value} of {row}");
        }
    }
}

#[test]
fn fanout_is_measured_while_one_of_eight_is_stopped() {
    let report = report(&["fanout"]);
    let phases = ["SCL, all run", "SCL, one stopped", "zeromq PUB, all run", "zeromq PUB, one stopped"];
    assert_eq!(names(&report), [&phases[..], &phases[..], &["SCL", "zeromq PUB"]].concat());
    assert_eq!(report["tables"][0]["rows"][0]["lost"], 0.0);
    // A stopped subscriber reads none of its fifty messages, and all of them fit into its queue and its socket.
    for row in report["tables"][2]["rows"].as_array().unwrap() {
        assert_eq!(row["messages"], 50.0, "{row}");
    }
    let [delays, sends] = [0, 1].map(|table| &report["tables"][table]);
    assert_compared(delays, "p50_us", "SCL, all run", &["zeromq PUB, all run"]);
    assert_compared(delays, "max_us", "SCL, one stopped", &["SCL, all run", "zeromq PUB, one stopped"]);
    assert_compared(sends, "p99_us", "SCL, one stopped", &["SCL, all run"]);
    assert_compared(sends, "p99_us", "zeromq PUB, one stopped", &["zeromq PUB, all run"]);
}

#[test]
fn codecs_are_compared_with_their_libraries() {
    let report = report(&["codecs"]);
    let expected = ["raw", "postcard", "protobuf", "prost alone", "msgpack", "cbor", "json", "serde_json alone"];
    assert_eq!(names(&report), expected);
    let bytes = |name: &str| row(&report["tables"][0], name)["bytes"].as_f64().unwrap();
    assert_eq!(bytes("protobuf"), bytes("prost alone"));
    assert_eq!(bytes("json"), bytes("serde_json alone"));
    assert!(bytes("postcard") < bytes("json"));
    assert_compared_everywhere(&report, "encode_ns", "json", &["serde_json alone"]);
    assert_compared_everywhere(&report, "decode_ns", "protobuf", &["prost alone"]);
}

/// The output for people.
fn text(arguments: &[&str]) -> String {
    String::from_utf8(bench(arguments).stdout).unwrap()
}

#[test]
fn tables_fit_into_100_columns() {
    for benchmark in ["roundtrip", "rate", "fresh", "restart", "delay", "fanout", "codecs"] {
        for line in text(&[benchmark, "--quick", "--histogram", "--cores", "one"]).lines() {
            assert!(line.chars().count() <= 100, "{benchmark}: {line}");
        }
    }
}

/// Lines with one space between words.
fn lines(text: &str) -> Vec<String> {
    text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn ratios_follow_the_values() {
    let lines = lines(&text(&["codecs", "--quick"]));
    let title = "encoding and decoding a record of booleans, integers, strings and floating point numbers";
    assert_eq!(lines[..2], [title, "encode ns decode ns bytes"]);
    assert!(lines[2].starts_with("raw ") && lines[3].starts_with("postcard "), "{lines:?}");
    assert_eq!(lines[10], "ratio encode ns decode ns");
    assert!(lines[11].starts_with("protobuf to prost alone "), "{lines:?}");
    assert!(lines[12].starts_with("json to serde_json alone "), "{lines:?}");
}

#[test]
fn histograms_follow_the_ratios() {
    let lines = lines(&text(&["roundtrip", "--bytes", "20", "--quick", "--histogram"]));
    let heading = lines.iter().position(|line| line == "50% 90% 99% 99.9% 99.99% max").unwrap();
    let line = &lines[heading + 1];
    assert!(line.starts_with("SCL pub/sub ") && line.contains('#') && line.ends_with('|'), "{line}");
}

#[test]
fn a_full_disk_is_an_error() {
    let full_disk = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_scl"));
    let output = command.args(["bench", "--quick", "codecs"]).stdout(full_disk).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let expected = "error: cannot write to standard output: No space left on device (os error 28)\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), expected);
}

#[test]
fn the_worker_command_is_internal() {
    let output = Command::new(env!("CARGO_BIN_EXE_scl")).args(["bench-worker", "rover"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let expected = "error: `bench-worker rover` is used internally by `scl bench`\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), expected);
}

#[test]
fn reports_say_where_the_processes_ran() {
    for (cores, expected) in [("any", false), ("one", true)] {
        let output = bench(&["codecs", "--quick", "--json", "--cores", cores]);
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let notes = report["notes"].as_array().unwrap();
        assert_eq!(notes.iter().any(|note| note == "all processes ran on one core"), expected, "{cores}: {notes:?}");
    }
}
