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
        let text = output(arguments, |arguments| rover.text(arguments));
        serde_json::from_str::<Value>(&text).unwrap_or_else(|error| panic!("{arguments:?}: {error}\n{text}"));
    }
    let streams = STREAMS.iter().map(|arguments| (arguments, output(arguments, |arguments| rover.text(arguments))));
    let measured =
        MEASUREMENTS.iter().map(|arguments| (arguments, output(arguments, |arguments| rover.measure(arguments))));
    for (arguments, text) in streams.chain(measured) {
        assert!(!text.is_empty(), "{arguments:?}");
        for line in text.lines() {
            let value = serde_json::from_str::<Value>(line);
            assert!(value.as_ref().is_ok_and(Value::is_object), "{arguments:?}: {value:?}\n{line}");
        }
    }
}

/// What a query prints, which has only characters that a terminal shows.
fn output(arguments: &[&str], ask: impl Fn(&[&str]) -> String) -> String {
    let text = ask(&[arguments, &["--format", "json"]].concat());
    let raw = text.chars().find(|&c| c != '\n' && (c.is_control() || c == '\u{202e}'));
    assert_eq!(raw, None, "{arguments:?}:\n{text}");
    assert!(text.ends_with('\n'), "{arguments:?}:\n{text}");
    text
}
