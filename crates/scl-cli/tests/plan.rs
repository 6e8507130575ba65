//! What `scl plan` prints, and that it comes back as the same plan.

use crate::system::System;
use expect_test::{Expect, expect};
use scl_plan::{Plan, SystemPlan};
use std::collections::BTreeSet;
use std::process::{Output, Stdio};

const ROVER: &str = "\
system: rover
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement, codec: json}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement, codec: json, queue: 1}
connections:
  - [sensor.measurements, controller.sensor]
";

fn scl_plan(files: &[(&str, &str)], arguments: &[&str]) -> Output {
    System::of_files(files).scl(&[&["plan"], arguments].concat()).output().unwrap()
}

#[track_caller]
fn check(files: &[(&str, &str)], arguments: &[&str], code: i32, expected_error: Expect) {
    let output = scl_plan(files, arguments);
    expected_error.assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(code), true));
}

#[test]
fn a_plan_names_everything_a_program_needs() {
    let output = scl_plan(&[("topology.yaml", ROVER)], &["--component", "controller"]);
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
    let text = String::from_utf8(output.stdout).unwrap();
    expect![[r#"
        {
          "version": 1,
          "system": "rover",
          "components": [
            {
              "name": "controller",
              "declared_at": "topology.yaml:6:11",
              "schema": null,
              "gates": [
                {
                  "name": "sensor",
                  "kind": "sub",
                  "payload": {
                    "message": "rover.Measurement"
                  },
                  "codec": "json",
                  "declared_at": "topology.yaml:8:9",
                  "endpoint": null,
                  "tap": null,
                  "contract": "ptascz5j",
                  "max_size": 67108864,
                  "queue": 1,
                  "when_full": "drop_oldest",
                  "backpressure": false,
                  "latched": false,
                  "timeout_ns": 1000000000,
                  "in_flight": 1,
                  "undecodable": "skip",
                  "connections": [
                    {
                      "peer_component": "sensor",
                      "peer_gate": "measurements",
                      "endpoint": "sensor.measurements--controller.sensor.ptascz5j",
                      "contract": "ptascz5j",
                      "required": true,
                      "queue": 1,
                      "when_full": "drop_oldest",
                      "max_size": 67108864
                    }
                  ]
                }
              ]
            }
          ],
          "schemas": {}
        }
    "#]]
    .assert_eq(&text);
    assert_eq!(Plan::from_json(&text).unwrap().to_json(), text);
}

#[test]
fn every_component_is_planned_in_file_order() {
    let text = String::from_utf8(scl_plan(&[("rover.yaml", ROVER)], &["rover.yaml"]).stdout).unwrap();
    let system = SystemPlan::from_json(&text).unwrap();
    let names: Vec<&str> = system.components.iter().map(|plan| plan.component.as_str()).collect();
    assert_eq!((system.system.as_str(), names), ("rover", vec!["sensor", "controller"]));
    assert_eq!(system.to_json(), text);
    assert_eq!(system.component("sensor").unwrap().gates[0].declared_at, "rover.yaml:5:9");
}

/// Two lamps of a kind, and one that is not.
const LAMPS: &str = "\
kinds:
  - {name: lamp, gates: []}
components:
  - {name: red, kind: lamp}
  - {name: white, gates: []}
  - {name: green, kind: lamp}
";

#[test]
fn the_plan_of_a_kind_is_that_of_its_components() {
    let of = |arguments: &[&str]| {
        let output = scl_plan(&[("topology.yaml", LAMPS)], arguments);
        let plan = SystemPlan::from_json(&String::from_utf8(output.stdout).unwrap()).unwrap();
        let kinds: Vec<String> =
            plan.kinds.iter().map(|kind| format!("{}={}", kind.name, kind.components.join("+"))).collect();
        let names: Vec<String> = plan.components.into_iter().map(|plan| plan.component).collect();
        format!("{} {}", names.join(","), kinds.join(","))
    };
    assert_eq!(of(&[]), "red,white,green lamp=red+green");
    assert_eq!(of(&["--component", "lamp"]), "red,green lamp=red+green");
    assert_eq!(of(&["--component", "green"]), "green ");
}

#[test]
fn messages_are_in_the_plan() {
    let schema = "syntax = \"proto3\"; package rover; message Measurement { double speed = 1; }";
    let yaml = ROVER.replace("system: rover", "schemas: [rover.proto]").replace(", codec: json", "");
    let lonely = "connections:\n  - [sensor.measurements, controller.sensor]";
    let yaml = yaml.replace(lonely, &format!("  - name: clock\n    gates: []\n{lonely}"));
    let output = scl_plan(&[("topology.yaml", &yaml), ("rover.proto", schema)], &[]);
    let system = SystemPlan::from_json(&String::from_utf8(output.stdout).unwrap()).unwrap();
    let schemas = ["sensor", "controller", "clock"].map(|name| system.component(name).unwrap().schema.clone());
    assert!(schemas[0].as_ref().unwrap().descriptors.windows(5).any(|bytes| bytes == b"speed"));
    assert_eq!((&schemas[1], &schemas[2]), (&schemas[0], &None));
}

#[test]
fn a_topology_is_read_from_standard_input() {
    let system = System::of_files(&[("rover.yaml", ROVER)]);
    let input = Stdio::from(std::fs::File::open(system.path("rover.yaml")).unwrap());
    let output = system.scl(&["plan", "-"]).stdin(input).output().unwrap();
    let plan = SystemPlan::from_json(&String::from_utf8(output.stdout).unwrap()).unwrap();
    assert_eq!(plan.components[1].declared_at, "<stdin>:6:11");
}

#[test]
fn an_unknown_component_is_answered_with_the_known_ones() {
    check(
        &[("topology.yaml", ROVER)],
        &["--component", "sensr"],
        1,
        expect![[r#"
        error: system `rover` has no component `sensr`; did you mean `sensor`?
          = note: its 2 components: `sensor`, `controller`
    "#]],
    );
    check(
        &[("topology.yaml", ROVER)],
        &["--component", "display"],
        1,
        expect![[r#"
        error: system `rover` has no component `display`
          = note: its 2 components: `sensor`, `controller`
    "#]],
    );
    let many = (0..12).map(|number| format!("  - name: part_{number}\n    gates: []\n"));
    let many = format!("components:\n{}", many.collect::<String>());
    check(
        &[("topology.yaml", &many)],
        &["--component", "display"],
        1,
        expect![[r#"
        error: system `topology` has no component `display`
          = note: its 12 components: `part_0`, `part_1`, `part_2`, `part_3`, `part_4`, `part_5`, `part_6`, `part_7`, `part_8`, `part_9`, ...
    "#]],
    );
}

#[test]
fn a_topology_with_errors_has_no_plan() {
    for (file, text, code) in [("topology.yaml", "unknown section `colour`", 1), ("nowhere.yaml", "cannot find", 2)] {
        let output = scl_plan(&[("topology.yaml", "colour: red\n")], &[file]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(text), "{error}");
        assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(code), true));
    }
}

/// `docs/plan.md` explains every field, and no other.
#[test]
fn the_format_is_documented() {
    let page = include_str!("../../../docs/plan.md");
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let names = rows.filter_map(|line| line.split('|').nth(1)).flat_map(|cell| cell.split(','));
    let documented: BTreeSet<&str> = names.map(|name| name.trim().trim_matches('`')).collect();
    let yaml = ROVER.replace(
        "gates:\n      - measurements",
        "gates:\n      - ask: {req: A -> B, unconnected: ok}\n      - measurements",
    );
    let yaml = yaml
        .replace("components:\n", "kinds:\n  - {name: lamp, gates: []}\ncomponents:\n  - {name: red, kind: lamp}\n");
    let text = String::from_utf8(scl_plan(&[("topology.yaml", &yaml)], &[]).stdout).unwrap();
    let keys = text.lines().filter_map(|line| line.trim().strip_prefix('"')?.split_once("\":"));
    let printed: BTreeSet<&str> = keys.map(|(key, _)| key).collect();
    assert_eq!(documented, printed);
    // The example is a shortened one of the same format.
    let example = page.split("```").nth(1).unwrap().trim_start_matches("json");
    let example = example.replace("CkwKC3Jv...", "");
    assert_eq!(SystemPlan::from_json(&example).unwrap().components[0].gates[0].connections.len(), 1);
}
