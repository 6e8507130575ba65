use super::*;
use crate::Plan;
use expect_test::expect;
use std::time::Duration;

fn parameter(kind: ParameterType, range: Option<(&str, &str)>) -> ParameterPlan {
    ParameterPlan {
        name: "gain".into(),
        kind,
        default: None,
        range: range.map(|(least, largest)| (least.to_owned().into(), largest.to_owned().into())),
        unit: None,
        doc: None,
        live: false,
        declared_at: "".into(),
    }
}

fn words(words: &[&'static str]) -> Cow<'static, [ConstText]> {
    words.iter().map(|word| Cow::Borrowed(*word)).collect()
}

#[test]
fn each_type_reads_its_values() {
    use ParameterValue::{Bool, Float, Integer, List, Text};
    let one = |scalar, text: &str| parameter(ParameterType::One(scalar), None).read(text);
    assert_eq!(one(Scalar::Bool, " true "), Ok(Bool(true)));
    assert_eq!(one(Scalar::I8, "-128"), Ok(Integer(-128)));
    assert_eq!(one(Scalar::U64, "18446744073709551615"), Ok(Integer(u64::MAX.into())));
    assert_eq!(one(Scalar::F64, "1e3"), Ok(Float(1000.0)));
    assert_eq!(one(Scalar::F32, "0.5"), Ok(Float(0.5)));
    assert_eq!(one(Scalar::Text, " a, b "), Ok(Text(" a, b ".to_owned())));
    assert_eq!(one(Scalar::Text, ""), Ok(Text(String::new())));
    assert_eq!(one(Scalar::Duration, "1.5ms"), Ok(ParameterValue::Duration(Duration::from_micros(1500))));
    let choice = parameter(ParameterType::OneOf(words(&["manual", "auto"])), None);
    assert_eq!(choice.read("auto"), Ok(Text("auto".to_owned())));
    let list = |length, text: &str| parameter(ParameterType::List(Scalar::U8, length), None).read(text);
    let expected = Ok(List(vec![Integer(1), Integer(2)]));
    for text in ["[1, 2]", "1,2", " [ 1,2 ] "] {
        assert_eq!(list(Some(2), text), expected, "{text}");
    }
    assert_eq!(list(None, "[]"), Ok(List(Vec::new())));
    assert_eq!(list(None, ""), Ok(List(Vec::new())));
}

#[test]
fn wrong_values_are_refused_with_the_reason() {
    let long = "7".repeat(LONGEST_VALUE + 1);
    let one = ParameterType::One;
    let list = |length| ParameterType::List(Scalar::F64, length);
    let cases = [
        (one(Scalar::Bool), "yes", "expected `true` or `false`, found `yes`"),
        (one(Scalar::U8), "256", "expected a whole number from 0 to 255, found `256`"),
        (one(Scalar::U8), "-1", "expected a whole number from 0 to 255, found `-1`"),
        (one(Scalar::I8), "1.0", "expected a whole number from -128 to 127, found `1.0`"),
        (one(Scalar::I8), "", "expected a whole number from -128 to 127, found ``"),
        (one(Scalar::F64), "nan", "expected a finite number, found `nan`"),
        (one(Scalar::F32), "1e39", "expected a finite number, found `1e39`"),
        (one(Scalar::Duration), "5", "the unit is missing: write `5s` or `5ms`"),
        (one(Scalar::Text), "a\0b", "a text cannot have NUL characters"),
        (one(Scalar::Text), &long, "the value has 65537 bytes, and may have 65536"),
        (ParameterType::OneOf(words(&["manual", "auto"])), "atuo", "expected `manual` or `auto`, found `atuo`"),
        (ParameterType::OneOf(words(&["manual", "auto"])), "x", "expected `manual` or `auto`, found `x`"),
        (list(Some(3)), "[1, 2]", "expected 3 items, found 2"),
        (list(None), "[1, 2", "one of the brackets `[` and `]` is missing"),
        (list(None), "[1,, 2]", "an item is empty"),
        (list(None), "[1, \"2]", "a quote `\"` is not closed"),
        (list(None), "[1, [2]]", "expected a finite number, found `[2]`"),
        (list(None), "[1, \"2\" 3]", "`\"2\" 3` goes on behind its quotes"),
    ];
    for (kind, text, expected) in cases {
        assert_eq!(parameter(kind, None).read(text), Err(expected.to_owned()), "{text}");
    }
}

#[test]
fn a_range_bounds_values_and_the_items_of_lists() {
    let gain = parameter(ParameterType::One(Scalar::F64), Some(("0", "10")));
    assert!(gain.read("0").is_ok() && gain.read("10").is_ok());
    assert_eq!(gain.read("10.1"), Err("`10.1` is not from 0 to 10".to_owned()));
    let period = parameter(ParameterType::One(Scalar::Duration), Some(("1ms", "1s")));
    assert!(period.read("1000ms").is_ok());
    assert_eq!(period.read("2s"), Err("`2s` is not from 1ms to 1s".to_owned()));
    let list = parameter(ParameterType::List(Scalar::I32, None), Some(("-1", "1")));
    assert!(list.read("[-1, 0, 1]").is_ok());
    assert_eq!(list.read("[0, 2]"), Err("`[0, 2]` is not from -1 to 1".to_owned()));
}

#[test]
fn a_parameter_that_contradicts_itself_is_no_plan() {
    let number = || parameter(ParameterType::One(Scalar::U8), None);
    let with_default = ParameterPlan { default: Some("300".into()), ..number() };
    let nameless = ParameterPlan { name: "".into(), ..number() };
    let cases = [
        (nameless, "parameter `it.` has no name"),
        (with_default, "has a wrong default: expected a whole number from 0 to 255, found `300`"),
        (parameter(ParameterType::OneOf(words(&[])), None), "has no words to choose from"),
        (parameter(ParameterType::OneOf(words(&["a", "a"])), None), "has a word twice"),
        (parameter(ParameterType::List(Scalar::U8, Some(0)), None), "is a list of 0 items"),
        (parameter(ParameterType::One(Scalar::Text), Some(("a", "b"))), "has a range, but its values have no order"),
        (parameter(ParameterType::One(Scalar::U8), Some(("9", "1"))), "has a range that is none"),
        (parameter(ParameterType::One(Scalar::U8), Some(("0", "256"))), "has a range that is none"),
    ];
    for (parameter, expected) in cases {
        let plan = Plan { component: "it".to_owned(), parameters: vec![parameter], ..of_one_component() };
        let error = plan.validate().unwrap_err().to_string();
        assert!(error.ends_with(expected), "{error}");
    }
}

#[test]
fn assignments_come_back_from_the_variable() {
    let values =
        ["2", "", "a, b", "[1, 2]", "[\"a, b\", c]", "say \"hi\"", "] [", "a\\b", " x ", "a=b", "[", "[a], [b]"];
    let given: Vec<Assignment> = values
        .iter()
        .map(|value| Assignment {
            component: "left_arm.planner".to_owned(),
            parameter: "name".to_owned(),
            value: (*value).to_owned(),
        })
        .collect();
    let text = set_text(&given);
    assert_eq!(assignments(&text), Ok(given), "{text}");
    assert_eq!(assignments(""), Ok(Vec::new()));
    let one = assignments("a.b=2, left_arm.planner.offsets=[1, 2],c.d=\"x\"").unwrap();
    let shown: Vec<String> = one.iter().map(|it| format!("{} {}", it.path(), it.value)).collect();
    assert_eq!(shown, ["a.b 2", "left_arm.planner.offsets [1, 2]", "c.d x"]);
}

#[test]
fn what_is_no_assignment_is_refused() {
    let expected = |text: &str| Err(format!("expected `component.parameter=value`, found `{text}`"));
    for text in ["gain", "gain=2", "a.gain", ".gain=2", "a.=2", "a b.gain=2"] {
        assert_eq!(Assignment::parse(text), expected(text), "{text}");
    }
    assert_eq!(assignments("a.b=[1, 2"), Err("a bracket `[` is not closed".to_owned()));
    assert_eq!(assignments("a.b=1]"), Err("a bracket `]` has no `[` before it".to_owned()));
    assert_eq!(assignments("a.b=1,").err(), expected("").err());
}

#[test]
fn lists_of_texts_come_back() {
    let items = ["a", "", "a, b", "\"", "[x]", " y ", "\\"];
    let text = list_text(items);
    let read = ParameterType::List(Scalar::Text, None).read(&text);
    let expected = items.map(|item| ParameterValue::Text(item.to_owned())).to_vec();
    assert_eq!(read, Ok(ParameterValue::List(expected)), "{text}");
}

/// One parameter of each form.
pub(crate) fn one_of_each_form() -> Vec<ParameterPlan> {
    let number = ParameterPlan {
        name: "gain".into(),
        kind: ParameterType::One(Scalar::F64),
        default: Some("0.8".into()),
        range: Some(("0".into(), "10".into())),
        unit: Some("1/s".into()),
        doc: Some("Proportional gain.".into()),
        live: true,
        declared_at: "rover.yaml:4:9".into(),
    };
    let choice = ParameterType::OneOf(["manual".into(), "auto".into()].to_vec().into());
    let plain = |name: &'static str, kind| ParameterPlan {
        name: name.into(),
        kind,
        default: None,
        range: None,
        unit: None,
        doc: None,
        live: false,
        declared_at: "rover.yaml:5:9".into(),
    };
    let lists = [("names", Scalar::Text, None), ("offsets", Scalar::F32, Some(3))];
    let lists = lists.map(|(name, scalar, length)| plain(name, ParameterType::List(scalar, length)));
    [number, plain("mode", choice)].into_iter().chain(lists).collect()
}

fn of_one_component() -> Plan {
    Plan {
        system: "rover".to_owned(),
        component: "clock".to_owned(),
        declared_at: "rover.yaml:2:5".to_owned(),
        schema: None,
        parameters: one_of_each_form(),
        gates: Vec::new(),
    }
}

#[test]
fn parameters_stand_before_the_gates() {
    let plan = of_one_component();
    expect![[r#"
        {
          "version": 1,
          "system": "rover",
          "components": [
            {
              "name": "clock",
              "declared_at": "rover.yaml:2:5",
              "schema": null,
              "parameters": [
                {
                  "name": "gain",
                  "type": "f64",
                  "default": "0.8",
                  "range": [
                    "0",
                    "10"
                  ],
                  "unit": "1/s",
                  "doc": "Proportional gain.",
                  "live": true,
                  "declared_at": "rover.yaml:4:9"
                },
                {
                  "name": "mode",
                  "one_of": [
                    "manual",
                    "auto"
                  ],
                  "declared_at": "rover.yaml:5:9"
                },
                {
                  "name": "names",
                  "list": "text",
                  "declared_at": "rover.yaml:5:9"
                },
                {
                  "name": "offsets",
                  "list": "f32",
                  "length": 3,
                  "declared_at": "rover.yaml:5:9"
                }
              ],
              "gates": []
            }
          ],
          "schemas": {}
        }
    "#]]
    .assert_eq(&plan.to_json());
}
