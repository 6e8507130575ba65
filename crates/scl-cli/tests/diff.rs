//! What `scl diff` says about two topologies, and its exit codes.

mod revisions;

use crate::system::System;
use expect_test::{Expect, expect};
use serde_json::{Value, json};
use std::process::Command;

const ROVER: &str = "\
system: rover
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
  - name: controller
    gates:
      - sensor: sub
      - commands: {rep: A -> B}
  - name: panel
    gates:
      - commands: req
connections:
  - [sensor.measurements, controller.sensor]
  - [panel.commands, controller.commands]
";

/// Compares the topology with itself after these replacements.
#[track_caller]
fn check(replacements: &[(&str, &str)], code: i32, expected: Expect) {
    let mut new = ROVER.to_owned();
    for (from, to) in replacements {
        assert!(new.contains(from), "{from}");
        new = new.replace(from, to);
    }
    let system = System::of_files(&[("old.yaml", ROVER), ("new.yaml", &new)]);
    let output = system.scl(&["diff", "old.yaml", "new.yaml"]).output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    expected.assert_eq(&String::from_utf8(output.stdout).unwrap());
    assert_eq!(output.status.code(), Some(code));
}

#[test]
fn what_means_the_same_is_the_same() {
    let swapped = ("[panel.commands, controller.commands]", "[controller.commands, panel.commands] # turned");
    check(&[swapped, ("commands: req", "commands: {req: A -> B, timeout: 1000ms}")], 0, expect![[""]]);
}

#[test]
fn a_copy_of_a_file_without_a_system_is_the_same() {
    let nameless = ROVER.replace("system: rover\n", "");
    let system = System::of_files(&[("old.yaml", &nameless), ("new.yaml", &nameless), ("named.yaml", ROVER)]);
    let told = |new: &str| {
        let output = system.scl(&["diff", "old.yaml", new]).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    assert_eq!(told("new.yaml"), (Some(0), String::new()));
    let (code, text) = told("named.yaml");
    assert!(code == Some(1) && text.starts_with("~ system: name from nothing to `rover`\n"), "{text}");
}

#[test]
fn a_type_concerns_both_ends() {
    check(
        &[("rover.Measurement", "rover.Reading")],
        1,
        expect![[r#"
            ~ gate `sensor.measurements`: type from `rover.Measurement` to `rover.Reading`
            ~ gate `controller.sensor`: type from `rover.Measurement` to `rover.Reading`
            ~ connection `sensor.measurements -> controller.sensor`: contract from `hl75aqsl` to `24knrqzm`, socket from `sensor.measurements--controller.sensor.hl75aqsl` to `sensor.measurements--controller.sensor.24knrqzm`

            to rebuild together:
              sensor: gate `measurements` differs, connection `sensor.measurements -> controller.sensor` differs
              controller: gate `sensor` differs, connection `sensor.measurements -> controller.sensor` differs
        "#]],
    );
}

#[test]
fn a_queue_concerns_its_senders() {
    check(
        &[("sensor: sub", "sensor: {sub: rover.Measurement, queue: 1}")],
        1,
        expect![[r#"
            ~ gate `controller.sensor`: queue from `100` to `1`

            to rebuild:
              sensor: connection `sensor.measurements -> controller.sensor` differs
              controller: gate `sensor` differs, connection `sensor.measurements -> controller.sensor` differs
        "#]],
    );
}

#[test]
fn the_longest_message_of_a_gate_concerns_its_peers() {
    check(
        &[("{rep: A -> B}", "{rep: A -> B, max_size: 1024KiB}")],
        1,
        expect![[r#"
            ~ gate `controller.commands`: max_size from `64MiB` to `1MiB`

            to rebuild:
              controller: gate `commands` differs
              panel: connection `panel.commands -> controller.commands` differs
        "#]],
    );
}

#[test]
fn a_component_comes_and_another_goes() {
    let logger =
        "  - name: logger\n    gates:\n      - input: sub\nconnections:\n  - [sensor.measurements, logger.input]";
    check(
        &[
            ("  - name: panel\n    gates:\n      - commands: req\n", ""),
            ("  - [panel.commands, controller.commands]\n", ""),
            ("{rep: A -> B}", "{rep: A -> B, unconnected: ok}"),
            ("connections:", logger),
        ],
        1,
        expect![[r#"
            - component `panel`
            + component `logger`
            - gate `panel.commands`: req A -> B
            ~ gate `controller.commands`: unconnected from `none` to `ok`
            + gate `logger.input`: sub rover.Measurement
            - connection `panel.commands -> controller.commands`
            + connection `sensor.measurements -> logger.input`

            to rebuild together:
              sensor: connection `sensor.measurements -> logger.input` is new
              logger: it is new

            to rebuild:
              controller: connection `panel.commands -> controller.commands` is gone
        "#]],
    );
}

#[test]
fn a_type_of_two_parts_is_told_clearly() {
    check(
        &[("{rep: A -> B}", "{rep: C -> B}")],
        1,
        expect![[r#"
        ~ gate `controller.commands`: type from `A -> B` to `C -> B`
        ~ gate `panel.commands`: type from `A -> B` to `C -> B`
        ~ connection `panel.commands -> controller.commands`: contract from `yrvcf33f` to `7wfuyvid`, socket from `controller.commands.yrvcf33f` to `controller.commands.7wfuyvid`

        to rebuild together:
          controller: gate `commands` differs, connection `panel.commands -> controller.commands` differs
          panel: gate `commands` differs, connection `panel.commands -> controller.commands` differs
    "#]],
    );
}

#[test]
fn only_components_that_part_are_rebuilt_together() {
    check(
        &[("rover.Measurement", "rover.Reading"), ("{rep: A -> B}", "{rep: A -> B, max_size: 1KiB}")],
        1,
        expect![[r#"
            ~ gate `sensor.measurements`: type from `rover.Measurement` to `rover.Reading`
            ~ gate `controller.sensor`: type from `rover.Measurement` to `rover.Reading`
            ~ gate `controller.commands`: max_size from `64MiB` to `1KiB`
            ~ connection `sensor.measurements -> controller.sensor`: contract from `hl75aqsl` to `24knrqzm`, socket from `sensor.measurements--controller.sensor.hl75aqsl` to `sensor.measurements--controller.sensor.24knrqzm`

            to rebuild together:
              sensor: gate `measurements` differs, connection `sensor.measurements -> controller.sensor` differs
              controller: gate `sensor` differs, connection `sensor.measurements -> controller.sensor` differs, gate `commands` differs

            to rebuild:
              panel: connection `panel.commands -> controller.commands` differs
        "#]],
    );
    // Both were connected to the component that is gone, but not to each other.
    check(
        &[
            ("  - name: controller\n    gates:\n      - sensor: sub\n      - commands: {rep: A -> B}\n", ""),
            ("  - [sensor.measurements, controller.sensor]\n  - [panel.commands, controller.commands]\n", ""),
            ("{pub: rover.Measurement}", "{pub: rover.Measurement, unconnected: ok}"),
            ("commands: req", "commands: {req: A -> B, unconnected: ok}"),
            ("connections:", "connections: []"),
        ],
        1,
        expect![[r#"
            - component `controller`
            - gate `controller.sensor`: sub rover.Measurement
            - gate `controller.commands`: rep A -> B
            ~ gate `sensor.measurements`: unconnected from `none` to `ok`
            ~ gate `panel.commands`: unconnected from `none` to `ok`
            - connection `sensor.measurements -> controller.sensor`
            - connection `panel.commands -> controller.commands`

            to rebuild:
              sensor: connection `sensor.measurements -> controller.sensor` is gone
              panel: connection `panel.commands -> controller.commands` is gone
        "#]],
    );
}

#[test]
fn words_for_people_need_no_rebuild() {
    check(
        &[("- name: sensor", "- name: sensor\n    doc: Reads.")],
        1,
        expect![[r#"
            ~ component `sensor`: doc from `none` to `"Reads."`

            nothing to rebuild
        "#]],
    );
}

#[test]
fn a_kind_and_the_system_change() {
    check(
        &[
            ("system: rover", "system: tank"),
            ("{pub: rover.Measurement}", "{push: rover.Measurement}"),
            ("sensor: sub", "sensor: pull"),
        ],
        1,
        expect![[r#"
            ~ system: name from `rover` to `tank`
            ~ gate `sensor.measurements`: kind from `pub` to `push`, share from nothing to `false`, latched from `false` to nothing
            ~ gate `controller.sensor`: kind from `sub` to `pull`
            ~ connection `sensor.measurements -> controller.sensor`: contract from `hl75aqsl` to `yj2a5wbk`, socket from `sensor.measurements--controller.sensor.hl75aqsl` to `controller.sensor.yj2a5wbk`

            to rebuild together:
              sensor: the system's name differs, gate `measurements` differs, connection `sensor.measurements -> controller.sensor` differs
              controller: the system's name differs, gate `sensor` differs, connection `sensor.measurements -> controller.sensor` differs
              panel: the system's name differs
        "#]],
    );
}

#[test]
fn optional_peers_are_not_waited_for() {
    check(
        &[("- name: panel", "- name: panel\n    optional: true")],
        1,
        expect![[r#"
            ~ component `panel`: optional from `false` to `true`

            to rebuild:
              controller: connection `panel.commands -> controller.commands` differs
        "#]],
    );
}

#[test]
fn a_bound_changes_no_plan() {
    check(
        &[("- name: controller", "- name: controller\n    memory: 32GiB")],
        1,
        expect![[r#"
        ~ component `controller`: memory from `no bound` to `32GiB`

        nothing to rebuild
    "#]],
    );
}

#[test]
fn a_parameter_concerns_one_program() {
    let parameters = "- name: controller\n    parameters:\n      - gain: {f64: 0.8}";
    let system = System::of_files(&[
        ("old.yaml", &ROVER.replace("- name: controller", parameters)),
        ("new.yaml", &ROVER.replace("- name: controller", &parameters.replace("0.8", "1, range: [0, 2]"))),
    ]);
    let output = system.scl(&["diff", "old.yaml", "new.yaml"]).output().unwrap();
    expect![[r#"
        ~ parameter `controller.gain`: default from `0.8` to `1`, range from `none` to `0 to 2`

        to rebuild:
          controller: parameter `gain` differs
    "#]]
    .assert_eq(&String::from_utf8(output.stdout).unwrap());
}

#[test]
fn json_says_the_same() {
    let new = ROVER.replace("sensor: sub", "sensor: {sub: rover.Measurement, queue: 1}");
    let system = System::of_files(&[("old.yaml", ROVER), ("new.yaml", &new)]);
    let output = system.scl(&["diff", "--format", "json", "old.yaml", "new.yaml"]).output().unwrap();
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let facts = json!({ "queue": { "old": "100", "new": "1" } });
    let changes = json!([{ "part": "gate", "name": "controller.sensor", "change": "changed", "facts": facts }]);
    assert_eq!(found["changes"], changes);
    let rebuilt: Vec<_> = found["rebuild"].as_array().unwrap().iter().map(|it| &it["component"]).collect();
    assert_eq!(rebuilt, ["sensor", "controller"]);
    assert_eq!(found["together"], json!([["sensor"], ["controller"]]), "a queue does not part them");
}

#[test]
fn trouble_is_told_of_both_files() {
    let system = System::of_files(&[("rover.yaml", ROVER), ("wrong.yaml", "colour: red\n")]);
    for (arguments, parts) in [
        (["wrong.yaml", "missing.yaml"], &["unknown section `colour`", "cannot find"][..]),
        (["rover.yaml", "wrong.yaml"], &["unknown section `colour`"]),
        (["-", "-"], &["standard input can be read only once"]),
    ] {
        let output = system.scl(&[&["diff"][..], &arguments].concat()).output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(parts.iter().all(|part| text.contains(part)), "{arguments:?}: {text}");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}

const SCHEMA: &str = "\
syntax = \"proto3\";
package rover;
message Measurement { double speed = 1; double angle = 2; Mode mode = 3; }
enum Mode { OFF = 0; ON = 1; }
message A { int32 x = 1; }
message B { int32 x = 1; }
";

/// Compares the topology with itself, with `SCHEMA` before and after these replacements.
#[track_caller]
fn check_schema(codec: &str, replacements: &[(&str, &str)], code: i32, expected: Expect) {
    let mut new = SCHEMA.to_owned();
    for (from, to) in replacements {
        assert!(new.contains(from), "{from}");
        new = new.replace(from, to);
    }
    let yaml = ROVER.replace("A -> B", "rover.A -> rover.B");
    let yaml = format!("schemas: [rover.proto]\n{codec}{yaml}");
    let system = System::of_files(&[
        ("old/rover.yaml", &yaml),
        ("old/rover.proto", SCHEMA),
        ("new/rover.yaml", &yaml),
        ("new/rover.proto", &new),
    ]);
    let output = system.scl(&["diff", "old/rover.yaml", "new/rover.yaml"]).output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    expected.assert_eq(&String::from_utf8(output.stdout).unwrap());
    assert_eq!(output.status.code(), Some(code));
}

#[test]
fn messages_that_differ_are_rebuilt_together() {
    let swapped = [("speed = 1", "speed = 2"), ("angle = 2", "angle = 1"), ("ON = 1", "ON = 2")];
    check_schema(
        "",
        &swapped,
        1,
        expect![[r#"
        ~ message `rover.Measurement`: field from `1 speed (double)` to `1 angle (double)`, field from `2 angle (double)` to `2 speed (double)`
        ~ enum `rover.Mode`: number from `ON = 1` to `ON = 2`

        to rebuild together:
          sensor: enum `rover.Mode` differs, message `rover.Measurement` differs
          controller: enum `rover.Mode` differs, message `rover.Measurement` differs
    "#]],
    );
    check_schema(
        "",
        &[("message A { int32 x = 1", "message A { repeated string x = 1")],
        1,
        expect![[r#"
        ~ message `rover.A`: field from `1 x (int32)` to `1 x (repeated string)`

        to rebuild together:
          controller: message `rover.A` differs
          panel: message `rover.A` differs
    "#]],
    );
    check_schema(
        "codec: json\n",
        &[("speed = 1", "velocity = 1")],
        1,
        expect![[r#"
        ~ message `rover.Measurement`: field from `1 speed (double)` to `1 velocity (double)`

        to rebuild together:
          sensor: message `rover.Measurement` differs
          controller: message `rover.Measurement` differs
    "#]],
    );
}

#[test]
fn compatible_messages_are_the_same() {
    let compatible = [
        ("Mode mode = 3;", "Mode mode = 3; string added = 4;"),
        ("ON = 1;", "ON = 1; MORE = 2;"),
        ("{ int32 x = 1; }", "{}"),
    ];
    check_schema("", &compatible, 0, expect![[""]]);
    check_schema("codec: json\n", &[("speed = 1", "speed = 2"), ("angle = 2", "angle = 1")], 0, expect![[""]]);
}
