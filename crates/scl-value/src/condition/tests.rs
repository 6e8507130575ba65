//! Conditions: what holds, and what is not one.

use super::*;
use crate::read_yaml;
use crate::testing::message_type;
use expect_test::{Expect, expect};
use proptest::prelude::*;

const MESSAGE: &str = "{speed: 1.84, count: 3, big: 9007199254740993, mode: AUTO, on: true, off: false, none: null, \
                       pose: {x: -1.5}, errors: [3, 5], limits: {'front left': 2}, nan: .nan, and: 1}";

#[test]
fn conditions_hold_or_not() {
    let message = read_yaml(MESSAGE).unwrap();
    let true_ones = [
        "speed > 1.5",
        "speed==1.84",
        "1.5 < speed",
        "count >= 3 and count <= 3",
        "count == 3.0",
        "big != 9007199254740992",
        "big == 9007199254740993",
        "mode == 'AUTO'",
        "mode == \"AUTO\"",
        "mode != 'MANUAL'",
        "mode < 'B'",
        "mode contains 'UT'",
        "errors contains 3",
        "not errors contains 4",
        "limits contains 'front left'",
        "limits.\"front left\" == 2",
        "pose.x < -1e0",
        "errors[1] == 5",
        "on",
        "not off",
        "on == true",
        "none == null",
        "off or on and on",
        "(off or on) and on",
        "not (off or missing > 1)",
        "nan != nan",
        "[\"and\"] == 1",
        "mode != 3",
    ];
    for text in true_ones {
        assert!(text.parse::<Condition>().unwrap().holds(&message).unwrap(), "{text}");
    }
    let false_ones = [
        "speed > 1.84",
        "speed > 'fast'",
        "mode > 3",
        "missing == 1",
        "missing != 1",
        "missing",
        "none",
        "nan == nan",
        "nan < 1",
        "off and on or off",
        "errors contains 4",
        "speed contains 1",
        "errors[2] == 5",
    ];
    for text in false_ones {
        assert!(!text.parse::<Condition>().unwrap().holds(&message).unwrap(), "{text}");
    }
}

#[test]
fn a_field_alone_must_be_a_boolean() {
    let message = read_yaml(MESSAGE).unwrap();
    let mut errors = String::new();
    for text in ["count", "on and mode", "not errors", "speed > 2 or pose"] {
        errors += &Problem::from(text.parse::<Condition>().unwrap().holds(&message).unwrap_err()).to_string();
    }
    expect![[r#"
        error: `count` is a number, which is neither true nor false
          = help: compare it, for example `count > 0`
        error: `mode` is a text, which is neither true nor false
          = help: compare it, for example `mode == 'text'`
        error: `errors` is a list, which is neither true nor false
          = help: compare it, for example `errors contains 1`
        error: `pose` is a map, which is neither true nor false
          = help: compare it, for example `pose contains 1`
    "#]]
    .assert_eq(&errors);
}

#[test]
fn conditions_are_checked_against_the_type() {
    let messages = message_type("rover.Measurement", "protobuf");
    for text in [
        "on",
        "not on and speed > 1",
        "mode == 'AUTO'",
        "'AUTO' != mode",
        "modes contains 'MANUAL'",
        "unit contains 'm'",
        "samples contains 1.5",
        "counts contains 'a' and counts.a > 2",
        "points contains 1",
        "points[1].x < pose.x",
        "track[0].x == 1",
        "limit == null",
        "raw_data == raw_data",
        "@unknown",
    ] {
        text.parse::<Condition>().unwrap().check(&messages).unwrap_or_else(|error| panic!("{text}: {error}"));
    }
    let known = message_type("rover.Known", "protobuf");
    for text in ["at > '2026-01-01'", "extra.anything", "maybe > 1", "value == 'x'"] {
        text.parse::<Condition>().unwrap().check(&known).unwrap_or_else(|error| panic!("{text}: {error}"));
    }
    let mut errors = String::new();
    for text in [
        "speed",
        "on and unit",
        "not mode",
        "speed > 'fast'",
        "unit == 3",
        "mode == 1",
        "mode == 'AUT'",
        "mode == AUTO",
        "on > false",
        "pose == 1",
        "samples == 1",
        "modes contains 'FAST'",
        "counts contains 1",
        "speed contains 1",
        "sped > 1",
    ] {
        let error = text.parse::<Condition>().unwrap().check(&messages).unwrap_err();
        // The list of all fields is told elsewhere.
        errors.extend(
            Problem::from(error)
                .to_string()
                .lines()
                .filter(|it| !it.contains("has the fields"))
                .map(|it| it.to_owned() + "\n"),
        );
    }
    expect![[r#"
        error: `speed` is a number, which is neither true nor false
          = help: compare it, for example `speed > 0`
        error: `unit` is a text, which is neither true nor false
          = help: compare it, for example `unit == 'text'`
        error: `mode` is the name of an enum value, which is neither true nor false
          = help: compare it, for example `mode == 'IDLE'`
        error: `speed` is a number, and `'fast'` is a text: they cannot be compared
          = help: put only texts in quotes
        error: `unit` is a text, and `3` is a number: they cannot be compared
          = help: put a text in quotes: `'text'`
        error: `mode` is the name of an enum value, and `1` is a number: they cannot be compared
          = help: put a text in quotes: `'text'`
        error: `'AUT'` is not the name of an enum value of the field
          = help: did you mean `'AUTO'`?
          = note: its names: `IDLE`, `AUTO`, `MANUAL`
        error: message `rover.Measurement` has no field `AUTO`
          = help: put a text in quotes: `'AUTO'`
          = note: its fields: `speed`, `position`, `i32`, `i64`, `u32`, `u64`, `s32`, `s64`, `f32`, `f64`, `sf32`, `sf64`, `on`, `unit`, `raw_data`, `mode`, `pose`, `samples`, `track`, `counts` and 8 more
        error: `on` is a boolean, which has no order
          = help: compare it with `==`
        error: `pose` is a message, and `1` is a number: they cannot be compared
        error: `samples` is a list, and `1` is a number: they cannot be compared
          = help: look for a value with `contains`, or name an element: `[0]`
        error: `'FAST'` is not the name of an enum value of the field
          = note: its names: `IDLE`, `AUTO`, `MANUAL`
        error: `counts` is a map in which each key is a text, and `1` is a number
        error: `speed` is a number, which contains nothing
          = help: compare it with `==`
        error: message `rover.Measurement` has no field `sped`
          = help: did you mean `speed`?
          = note: its fields: `speed`, `position`, `i32`, `i64`, `u32`, `u64`, `s32`, `s64`, `f32`, `f64`, `sf32`, `sf64`, `on`, `unit`, `raw_data`, `mode`, `pose`, `samples`, `track`, `counts` and 8 more
    "#]]
    .assert_eq(&errors);
}

#[track_caller]
fn check_error(text: &str, expected: Expect) {
    expected.assert_eq(&text.parse::<Condition>().unwrap_err().to_string());
}

#[test]
fn a_text_that_is_no_condition_says_why_and_where() {
    check_error("", expect!["`` is not a condition: expected a field or a value at character 1"]);
    check_error("speed >", expect!["`speed >` is not a condition: expected a field or a value at character 8"]);
    check_error(
        "speed > 1 2",
        expect!["`speed > 1 2` is not a condition: expected `and`, `or` or the end at character 11"],
    );
    check_error(
        "speed > 1 and",
        expect!["`speed > 1 and` is not a condition: expected a field or a value at character 14"],
    );
    check_error("(speed > 1", expect!["`(speed > 1` is not a condition: expected `)` at character 11"]);
    check_error("speed > 1x", expect!["`speed > 1x` is not a condition: `1x` is not a number at character 9"]);
    check_error("mode == 'AUTO", expect!["`mode == 'AUTO` is not a condition: a quote is not closed at character 9"]);
    check_error(
        "3",
        expect!["`3` is not a condition: expected `==`, `!=`, `<`, `<=`, `>`, `>=` or `contains` at character 2"],
    );
    check_error(
        "speed > 1 && mode == 'x'",
        expect!["`speed > 1 && mode == 'x'` is not a condition: expected `and`, `or` or the end at character 11"],
    );
    check_error("ä > > 1", expect!["`ä > > 1` is not a condition: a name is expected before `>` at character 5"]);
    let deep = "(".repeat(100_000);
    assert!(deep.parse::<Condition>().is_err());
}

proptest! {
    #[test]
    fn no_text_panics(text in r"([a-c.\[\]0-9'()<>=! ä]|and|or|not|contains){0,40}") {
        if let Ok(condition) = text.parse::<Condition>() {
            let _not_boolean = condition.holds(&read_yaml(MESSAGE).unwrap());
        }
    }
}
