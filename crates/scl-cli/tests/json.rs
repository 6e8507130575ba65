//! `--format json` of every query: one JSON value, or one object a line, and nothing else on standard output.

use crate::rover::Rover;
use serde_json::Value;

/// Queries whose answer is one value.
const VALUES: &[&[&str]] = &[
    &["list"],
    &["list", "-v"],
    &["info", "sensor"],
    &["info", "sensor.measurements"],
    &["info", "controller.commands"],
    &["call", "controller.commands", "--template"],
    &["plan", "--memory"],
];

/// Queries whose answer is a stream, with what ends it.
const STREAMS: &[&[&str]] = &[
    &["echo", "sensor.measurements", "-n", "3"],
    &["echo", "controller.commands", "logger.events", "sensor.image", "-n", "9"],
    #[cfg(feature = "run")]
    &["log", "sensor"],
];

/// Measurements, whose answer is a stream too.
const MEASUREMENTS: &[&[&str]] = &[
    &["hz", "sensor.measurements", "logger.events", "--once", "--for", "300ms"],
    &["bw", "sensor.measurements", "--once", "--for", "300ms"],
    &["delay", "sensor.measurements", "--once", "--for", "300ms"],
];

/// A log of the sensor, as `scl run` writes it, with characters that a terminal would obey.
const LOG: &str = "{\"time\":\"2026-11-22T00:05:09.250Z\",\"component\":\"sensor\",\"stream\":\"stdout\",\"run\":1,\
                   \"text\":\"\\u001b[31m \u{7f} \u{9b} \u{202e}\"}\n";

#[test]
fn every_query_answers_in_json() {
    let rover = Rover::start();
    std::fs::create_dir_all(rover.path("state/scl/rover")).unwrap();
    std::fs::write(rover.path("state/scl/rover/sensor.log"), LOG).unwrap();
    for arguments in VALUES {
        let text = rover.text(&in_json(arguments));
        check_characters(arguments, &text);
        serde_json::from_str::<Value>(&text).unwrap_or_else(|error| panic!("{arguments:?}: {error}\n{text}"));
    }
    let streams = STREAMS.iter().map(|arguments| (arguments, rover.text(&in_json(arguments))));
    let measured = MEASUREMENTS.iter().map(|arguments| (arguments, rover.measure(&in_json(arguments))));
    for (arguments, text) in streams.chain(measured) {
        check_characters(arguments, &text);
        assert!(!text.is_empty(), "{arguments:?}");
        for line in text.lines() {
            let value = serde_json::from_str::<Value>(line);
            assert!(value.as_ref().is_ok_and(Value::is_object), "{arguments:?}: {value:?}\n{line}");
        }
    }
}

fn in_json<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    [arguments, &["--format", "json"]].concat()
}

/// What a query prints has only characters that a terminal shows.
fn check_characters(arguments: &[&str], text: &str) {
    let raw = text.chars().find(|&c| c != '\n' && (c.is_control() || c == '\u{202e}'));
    assert_eq!(raw, None, "{arguments:?}:\n{text}");
    assert!(text.ends_with('\n'), "{arguments:?}:\n{text}");
}
