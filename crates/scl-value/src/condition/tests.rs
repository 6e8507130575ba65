//! Conditions: what holds, and what is not one.

use super::*;
use crate::read_yaml;
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
        assert!(text.parse::<Condition>().unwrap().holds(&message), "{text}");
    }
    let false_ones = [
        "speed > 1.84",
        "speed > 'fast'",
        "mode > 3",
        "missing == 1",
        "missing != 1",
        "missing",
        "count",
        "speed",
        "nan == nan",
        "nan < 1",
        "off and on or off",
        "errors contains 4",
        "speed contains 1",
        "errors[2] == 5",
    ];
    for text in false_ones {
        assert!(!text.parse::<Condition>().unwrap().holds(&message), "{text}");
    }
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
            condition.holds(&read_yaml(MESSAGE).unwrap());
        }
    }
}
