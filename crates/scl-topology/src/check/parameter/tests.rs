use super::{NO_EFFECT, NO_PARAMETER, OF_KIND, TAKEN, WORDS};
use crate::check::testing::{advice, codes, rule_example, topology};
use expect_test::expect;
use scl_plan::ParameterPlan;

/// A component with these parameters.
pub(super) fn file(parameters: &str) -> String {
    let items: String = parameters.lines().map(|line| format!("      - {}\n", line.trim())).collect();
    format!("components:\n  - name: controller\n    parameters:\n{items}    gates: []\n")
}

pub(super) fn declared(parameters: &str) -> Vec<ParameterPlan> {
    let topology = topology(&file(parameters));
    topology.components().flat_map(|(_, it)| it.parameters()).map(|it| it.declared().clone()).collect()
}

#[test]
fn every_type_can_be_declared() {
    let shown = declared(
        "pin: u8
         gain: {f64: 0.8, range: [0, 10], unit: 1/s, doc: Proportional gain.}
         period: {duration: 10ms, range: [1ms, 1s]}
         label: {text: left}
         empty: {text: \"\"}
         enabled: {bool: true}
         mode: {one_of: [manual, auto], default: manual}
         choice: {one_of: [manual, auto]}
         offsets: {list: f64, length: 3, default: [0, 0.5, 1]}
         names: {list: text, default: [\"a, b\", c]}
         none: {list: i32, default: []}
         bounded: {f32: , range: [0, 1]}",
    );
    let line = |it: &ParameterPlan| {
        let texts = [&it.default, &it.unit, &it.doc].map(|text| text.as_deref().unwrap_or("-").to_owned());
        let range = it.range.as_ref().map_or("-".to_owned(), |(least, largest)| format!("{least}..{largest}"));
        format!("{}: {} = {}\n", it.name, it.kind, [texts.to_vec(), vec![range]].concat().join("; "))
    };
    expect![[r#"
        pin: u8 = -; -; -; -
        gain: f64 = 0.8; 1/s; Proportional gain.; 0..10
        period: duration = 10ms; -; -; 1ms..1s
        label: text = left; -; -; -
        empty: text = ; -; -; -
        enabled: bool = true; -; -; -
        mode: one of `manual` and `auto` = manual; -; -; -
        choice: one of `manual` and `auto` = -; -; -; -
        offsets: list of 3 f64 = [0, 0.5, 1]; -; -; -
        names: list of text = ["a, b", c]; -; -; -
        none: list of i32 = []; -; -; -
        bounded: f32 = -; -; -; 0..1
    "#]]
    .assert_eq(&shown.iter().map(line).collect::<String>());
}

#[test]
fn entries_that_are_no_parameters_are_told_with_what_is_meant() {
    let cases = [
        "gain",
        "gain: 0.8",
        "gain: true",
        "period: 10ms",
        "offsets: [0, 0.5]",
        "gain: float",
        "gain: {float: 0.8}",
        "gain: {type: double, default: 0.8}",
        "gain: {default: 0.8}",
        "gain: {f64: 0.8, f32: 1}",
        "gain: {f64: 0.8, description: text}",
        "gain: {f64: 0.8, rnage: [0, 1]}",
        "gain: {f64: {a: 1}}",
        "gain: {f64: 0.8, range: [[0], 1]}",
        "gain: {f64: 0.8, range: {max: 1, min: 0}}",
        "gain: {f64: 0.8, range: {min: 0}}",
        "gain: {list: {f64: 1}}",
        "gain: {list: f64, default: {x: 1}}",
        "gain: {f64: 0.8, unit: }",
        "gain:",
        "mode: {one_of: manual}",
        "mode: one_of",
        "names: list",
        "names: {list: [a, b]}",
        "names: {list: list}",
        "gain: {f64: 1}, pin: u8",
    ];
    let told: String = cases.iter().map(|case| format!("{case}\n    {}\n", advice(&file(case)))).collect();
    expect![[r#"
        gain
            SCL1901 a parameter has no type [a parameter is a name and a type: `- gain: f64`, or with a default: `- gain: {f64: 0.8}`]
        gain: 0.8
            SCL1901 parameter `gain` has a value, but no type [write `gain: {f64: 0.8}`]
        gain: true
            SCL1901 parameter `gain` has a value, but no type [write `gain: {bool: true}`]
        period: 10ms
            SCL1901 parameter `period` has a value, but no type [write `period: {duration: 10ms}`]
        offsets: [0, 0.5]
            SCL1901 parameter `offsets` has a value, but no type [write `offsets: {list: f64, default: [0, 0.5]}`]
        gain: float
            SCL1901 unknown type `float` of parameter `gain` [did you mean `f64` or `f32`?]
        gain: {float: 0.8}
            SCL1901 unknown type `float` of parameter `gain` [write `f64` or `f32`]
        gain: {type: double, default: 0.8}
            SCL1901 the type of parameter `gain` is a key [write `{f64: ...}` with the default in place of the dots, or `f64` alone]
        gain: {default: 0.8}
            SCL1901 parameter `gain` has no type [a parameter is a name and a type: `- gain: f64`, or with a default: `- gain: {f64: 0.8}`]
        gain: {f64: 0.8, f32: 1}
            SCL1901 parameter `gain` has two types [remove one of them]
        gain: {f64: 0.8, description: text}
            SCL1901 unknown key `description` of a parameter [did you mean `doc`?]
        gain: {f64: 0.8, rnage: [0, 1]}
            SCL1901 unknown key `rnage` of a parameter [did you mean `range`?]
        gain: {f64: {a: 1}}
            SCL1901 `f64` is a single value, or a list [the default stands behind the type, and anything else beside it: `{f64: ..., doc: ...}`]
        gain: {f64: 0.8, range: [[0], 1]}
            SCL1901 `range` is a list of single values [each item is a number, a text, a duration, or `true` or `false`]
        gain: {f64: 0.8, range: {max: 1, min: 0}}
            SCL1901 `range` is a single value, or a list [write `range: [0, 1]`]
        gain: {f64: 0.8, range: {min: 0}}
            SCL1901 `range` is a single value, or a list [write the least and the largest value: `range: [0, 10]`]
        gain: {list: {f64: 1}}
            SCL1901 `list` is a single value, or a list [write for example `{list: f64, length: 3, default: [0, 0, 0]}`]
        gain: {list: f64, default: {x: 1}}
            SCL1901 `default` is a single value, or a list [a parameter has no parts: declare a parameter for each]
        gain: {f64: 0.8, unit: }
            SCL0110 the value of `unit` is empty [a value follows the colon | remove `unit`]
        gain:
            SCL1901 parameter `gain` has no type [a parameter is a name and a type: `- gain: f64`, or with a default: `- gain: {f64: 0.8}`]
        mode: {one_of: manual}
            SCL1901 `one_of` is a list of words [write the words in brackets: `{one_of: [manual, auto], default: manual}`]
        mode: one_of
            SCL1901 `one_of` is a list of words [write the words in brackets: `{one_of: [manual, auto], default: manual}`]
        names: list
            SCL1901 `list` names the type of its items [write for example `{list: f64, length: 3, default: [0, 0, 0]}`]
        names: {list: [a, b]}
            SCL1901 `list` names the type of its items [write for example `{list: f64, length: 3, default: [0, 0, 0]}`]
        names: {list: list}
            SCL1901 `list` names the type of its items [write for example `{list: f64, length: 3, default: [0, 0, 0]}`]
        gain: {f64: 1}, pin: u8
            SCL0125 `, pin: u8` is not expected here after `}` [write it inside the braces, after a comma, or remove it]
    "#]].assert_eq(&told);
}

#[test]
fn names_and_words_must_be_free() {
    let cases = [
        "gain: f64\ngain: u8",
        "set-point: f64\nsetPoint: u8",
        "crate: u8",
        "a b: u8",
        "mode: {one_of: [manual, manual]}",
        "mode: {one_of: [set-point, setPoint]}",
        "mode: {one_of: [1, 2]}",
        "mode: {one_of: [self]}",
        "peer: {one_of: [a, b]}",
        "parameters: {one_of: [a, b]}",
        "a_b: {one_of: [a, b]}\na-b: u8",
    ];
    let told: String = cases.iter().map(|case| format!("{case}\n    {}\n", advice(&file(case)))).collect();
    expect![[r#"
        gain: f64
        gain: u8
            SCL1904 component `controller` declares parameter `gain` twice [give one of them another name]
        set-point: f64
        setPoint: u8
            SCL1904 parameters `set-point` and `setPoint` of `controller` would both become the field `set_point` [give one of them another name]
        crate: u8
            SCL0307 `crate` is a Rust keyword that cannot be used as a name, not even as `r#crate` [the name is any other word of letters, digits, `_` and `-`]
        a b: u8
            SCL0303 a parameter name cannot contain a space [write `a_b`]
        mode: {one_of: [manual, manual]}
            SCL1906 parameter `mode` lists `manual` twice [remove one of them]
        mode: {one_of: [set-point, setPoint]}
            SCL1906 two words of parameter `mode` would become `SetPoint` [rename one of them]
        mode: {one_of: [1, 2]}
            SCL1906 `1` cannot be a word of parameter `mode` [a word consists of letters, digits, `_` and `-`, and starts with a letter]; SCL1906 `2` cannot be a word of parameter `mode` [a word consists of letters, digits, `_` and `-`, and starts with a letter]
        mode: {one_of: [self]}
            SCL1906 `self` cannot be a word of parameter `mode` [`Self` is a keyword of Rust: choose another word]
        peer: {one_of: [a, b]}
            SCL1906 the words of `controller.peer` would become the type `ControllerPeer`, like the counterpart of `controller` in tests [give one of them another name]
        parameters: {one_of: [a, b]}
            SCL1906 the words of `controller.parameters` would become the type `ControllerParameters`, like the parameters of `controller` [give one of them another name]
        a_b: {one_of: [a, b]}
        a-b: u8
            SCL1904 parameters `a_b` and `a-b` of `controller` would both become the field `a_b` [give one of them another name]
    "#]].assert_eq(&told);
}

#[test]
fn gates_do_not_share_names_with_parameters() {
    let with_gate = |gate: &str| file("gain: f64").replace("gates: []", &format!("gates: [{{{gate}: pub}}]"));
    let told = ["gain", "Gain", "parameters", "other"].map(|gate| advice(&with_gate(gate)));
    expect![[r#"
        SCL1904 a gate and a parameter of `controller` are called `gain` [give one of them another name]
        SCL1904 a gate and a parameter of `controller` are called `gain` [give one of them another name]
        SCL1904 gate `parameters` of `controller` has the name of the field with its parameters [give the gate another name]
    "#]].assert_eq(&told.join("\n"));
    let without = "components:\n  - name: controller\n    gates: [{parameters: {pub: , unconnected: ok}}]\n";
    assert!(!codes(without).contains(&"SCL1904"), "a component without parameters may have such a gate");
}

#[test]
fn a_component_may_be_called_like_a_generated_type_only_if_there_is_none() {
    let other = |name: &str, parameters: &str| format!("{}  - {{name: {name}, gates: []}}\n", file(parameters));
    assert!(!codes(&other("controller_gain", "gain: f64")).contains(&"SCL1906"));
    for (name, parameters) in [("controller_mode", "mode: {one_of: [a, b]}"), ("controller_parameters", "gain: f64")] {
        assert!(codes(&other(name, parameters)).contains(&"SCL1906"), "{name}");
    }
}

#[test]
fn components_of_a_kind_have_its_parameters() {
    let yaml = "kinds:\n  - name: motor\n    parameters:\n      - pin: u8\n    gates: []\n\
                components:\n  - {name: left, kind: motor}\n  - {name: right, kind: motor}\n";
    let topology = topology(yaml);
    let names = topology.components().map(|(_, it)| it.parameters().iter().map(|it| it.name()).collect::<Vec<_>>());
    assert_eq!(names.collect::<Vec<_>>(), [["pin"], ["pin"]]);
}

#[test]
fn not_a_parameter() {
    rule_example(
        &NO_PARAMETER,
        expect![[r#"
        error: [SCL1901] parameter `gain` has a value, but no type
         --> topology.yaml:4:15
          |
        4 |       - gain: 0.8
          |               ^^^ a value, where a type is expected
          |
          = help: write `gain: {f64: 0.8}`
    "#]],
    );
}

#[test]
fn key_that_the_type_does_not_have() {
    rule_example(
        &NO_EFFECT,
        expect![[r#"
        error: [SCL1903] `range` has no effect on a parameter of type `text`
         --> topology.yaml:4:29
          |
        4 |       - label: {text: left, range: [0, 10]}
          |                             ^^^^^ numbers and durations have one
          |
          = help: remove it
    "#]],
    );
}

#[test]
fn name_of_a_parameter_is_taken() {
    rule_example(
        &TAKEN,
        expect![[r#"
        error: [SCL1904] component `controller` declares parameter `gain` twice
         --> topology.yaml:5:9
          |
        4 |       - gain: f64
          |         ---- first declaration
        5 |       - gain: u8
          |         ^^^^ second declaration
          |
          = help: give one of them another name
    "#]],
    );
}

#[test]
fn component_of_a_kind_with_parameters_of_its_own() {
    rule_example(
        &OF_KIND,
        expect![[r#"
        error: [SCL1905] component `left_motor` is of a kind, and has parameters of its own
         --> topology.yaml:9:9
          |
        7 |     kind: motor
          |           ----- all of this kind have the same parameters
        8 |     parameters:
        9 |       - pin: u8
          |         ^^^
          |
          = help: declare them at the kind `motor`
          = help: or remove them
    "#]],
    );
}

#[test]
fn words_that_cannot_become_an_enum() {
    rule_example(
        &WORDS,
        expect![[r#"
            error: [SCL1906] two words of parameter `mode` would become `Manual`
             --> topology.yaml:4:33
              |
            4 |       - mode: {one_of: [manual, Manual]}
              |                         ------  ^^^^^^ the second one
              |                         |
              |                         the first one
              |
              = help: rename one of them
        "#]],
    );
}
