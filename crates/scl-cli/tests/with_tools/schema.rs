//! `scl schema`: agrees with the checker, and is understood by the real YAML language server.

mod agreement;

use crate::lsp::Server;
use crate::system::System;
use scl_needs::needs;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

const ROVER: &str = "\
# yaml-language-server: $schema=topology.schema.json
system: rover
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement, doc: Readings.}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement, queue: 1, when_full: drop_newest}
      - commands: {rep: A -> B, unconnected: ok}
connections:
  - [sensor.measurements, controller.sensor]
x-note: anything
";

const KINDS: [&str; 6] = ["pub", "sub", "req", "rep", "push", "pull"];

fn scl(system: &System, arguments: &[&str]) -> String {
    let output = system.scl(arguments).output().unwrap();
    String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap()
}

fn schema(system: &System, arguments: &[&str]) -> Value {
    serde_json::from_str(&scl(system, &[&["schema"], arguments].concat())).unwrap()
}

/// The words in backticks after `start` in what the checker says about a file.
fn listed(yaml: &str, start: &str) -> Vec<String> {
    let text = scl(&System::of_files(&[("topology.yaml", yaml)]), &["check"]);
    let list = text.split_once(start).unwrap_or_else(|| panic!("no `{start}` in\n{text}")).1.lines().next().unwrap();
    let mut words: Vec<String> = list.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    words.sort();
    words
}

fn keys(schema: &Value) -> Vec<String> {
    let mut keys: Vec<String> = schema["properties"].as_object().unwrap().keys().cloned().collect();
    keys.sort();
    keys
}

#[test]
fn the_schema_has_the_keys_of_the_checker() {
    let schema = schema(&System::of_files(&[]), &[]);
    let component = &schema["properties"]["components"]["items"];
    assert_eq!(keys(&schema), listed("colour: red\n", "sections: "));
    assert_eq!(keys(component), listed("components: [{name: a, gates: [], colour: red}]\n", "keys of a component: "));
    let gates = component["properties"]["gates"]["items"]["additionalProperties"]["anyOf"].as_array().unwrap();
    assert_eq!(gates[0]["enum"], json!(KINDS));
    for (kind, gate) in KINDS.iter().zip(&gates[1..]) {
        let yaml = format!("components: [{{name: a, gates: [{{b: {{{kind}: T, colour: red}}}}]}}]\n");
        assert_eq!(keys(gate), listed(&yaml, &format!("keys of a `{kind}` gate: ")), "{kind}");
    }
}

/// The schema of the option `max_size` of a kind, if it has one.
fn max_size(kind: &str) -> Value {
    let schema = schema(&System::of_files(&[]), &[]);
    let gates = &schema["properties"]["components"]["items"]["properties"]["gates"]["items"]["additionalProperties"];
    let gate = gates["anyOf"].as_array().unwrap().iter().find(|gate| gate["title"] == format!("{kind} gate")).unwrap();
    gate["properties"]["max_size"].clone()
}

#[test]
fn receiving_gates_have_a_largest_size() {
    assert_eq!(KINDS.map(|kind| !max_size(kind).is_null()), [false, true, true, true, false, true]);
    assert_eq!((&max_size("sub")["default"], &max_size("rep")["type"]), (&json!("64MiB"), &json!("string")));
    let told = max_size("pull")["description"].as_str().unwrap().to_owned();
    assert!(told.contains("`KiB`") && told.contains("to 1GiB"), "{told}");
}

#[test]
fn everything_has_a_description() {
    fn look(schema: &Value, place: &str) {
        for (key, property) in schema["properties"].as_object().into_iter().flatten() {
            let place = format!("{place}.{key}");
            assert!(property["description"].as_str().is_some_and(|text| !text.is_empty()), "{place}");
            look(property, &place);
        }
        for key in ["items", "additionalProperties"] {
            if schema[key].is_object() {
                look(&schema[key], &format!("{place}.{key}"));
            }
        }
        schema["anyOf"].as_array().into_iter().flatten().for_each(|other| look(other, place));
    }
    look(&schema(&System::of_files(&[]), &[]), "");
}

#[test]
fn a_file_adds_its_gates_even_with_errors() {
    let wrong = ROVER.replace("sensor.measurements,", "sensor.nothing,");
    let system = System::of_files(&[("topology.yaml", &wrong)]);
    let end = &schema(&system, &["topology.yaml"])["properties"]["connections"]["items"]["items"]["anyOf"][0];
    assert_eq!(end["enum"], json!(["sensor.measurements", "controller.sensor", "controller.commands"]));
    assert_eq!(end["enumDescriptions"][0], "pub rover.Measurement");
    let output = system.scl(&["schema", "missing.yaml"]).output().unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
}

#[test]
fn of_groups_the_exported_gates_are_offered() {
    let main = "\
include:
  - {file: arm.yaml, as: left_arm}
  - {file: arm.yaml, as: right_arm}
components:
  - {name: pilot, gates: [{left: {pub: Command}}]}
connections:
  - [pilot.left, left_arm.command]
";
    let arm = "\
components:
  - {name: planner, gates: [{command: {sub: Command}}, {path: {pub: Path}}]}
exports: {command: planner.command}
";
    let offered = |file: &str| {
        let system = System::of_files(&[("topology.yaml", main), ("arm.yaml", arm)]);
        schema(&system, &[file])["properties"]["connections"]["items"]["items"]["anyOf"][0]["enum"].clone()
    };
    assert_eq!(offered("topology.yaml"), json!(["pilot.left", "left_arm.command", "right_arm.command"]));
    assert_eq!(offered("arm.yaml"), json!(["planner.command", "planner.path"]));
}

/// The server's program, installed below the target folder once.
fn language_server() -> PathBuf {
    let modules = crate::npm::installed("yaml-language-server", "1.25.0");
    modules.join("yaml-language-server/bin/yaml-language-server")
}

/// The server on the files of a system that has its schema beside the topology.
fn serve(system: &System, program: &Path) -> Server {
    system.write("topology.schema.json", &scl(system, &["schema", "topology.yaml"]));
    let settings =
        json!({ "yaml": { "schemaStore": { "enable": false }, "completion": true, "validate": true, "hover": true } });
    Server::start(Command::new("node").arg(program).arg("--stdio"), &system.path(""), settings)
}

#[needs("node", "npm")]
#[test]
fn the_yaml_language_server_validates_and_completes() {
    let program = language_server();
    let system = System::of_files(&[("topology.yaml", ROVER)]);
    let mut server = serve(&system, &program);
    let document = |name: &str| system.path(name);

    server.open(&document("good.yaml"), "yaml", ROVER);
    assert_eq!(server.diagnostics(&document("good.yaml")), Vec::<Value>::new());

    let sized = ROVER.replace("queue: 1", "queue: 1, max_size: 512KiB").replace("A -> B", "A -> B, max_size: 8 MiB");
    server.open(&document("sized.yaml"), "yaml", &sized);
    assert_eq!(server.diagnostics(&document("sized.yaml")), Vec::<Value>::new());

    let wrong =
        ROVER.replace("queue: 1", "queue: 0").replace("doc: Readings.", "timeout: 1s").replace("rep:", "reply:");
    server.open(&document("wrong.yaml"), "yaml", &wrong);
    let found = server.diagnostics(&document("wrong.yaml"));
    let mut lines: Vec<_> = found.iter().map(|it| it["range"]["start"]["line"].as_u64().unwrap()).collect();
    lines.dedup();
    assert_eq!(lines, [5, 8, 9], "{found:#?}");

    for size in ["65536", "8MB", "1.5MiB"] {
        let wrong = ROVER.replace("queue: 1", &format!("max_size: {size}"));
        let name = document(&format!("size_{size}.yaml"));
        server.open(&name, "yaml", &wrong);
        let found = server.diagnostics(&name);
        assert!(found.iter().any(|it| it["range"]["start"]["line"] == 8), "{size}: {found:#?}");
    }

    let typing = ROVER.replace("- [sensor.measurements, controller.sensor]", "- [sensor.measurements, ]\n  - ");
    server.open(&document("typing.yaml"), "yaml", &typing);
    let offered = server.complete_behind(&document("typing.yaml"), &typing, "- [sensor.measurements, ");
    for end in ["sensor.measurements", "controller.sensor", "controller.commands"] {
        assert!(offered.iter().any(|it| it == end), "`{end}` is not in {offered:?}");
    }

    let typing = ROVER.replace(", when_full: drop_newest", ", whe");
    server.open(&document("option.yaml"), "yaml", &typing);
    let offered = server.complete_behind(&document("option.yaml"), &typing, "queue: 1, whe");
    assert!(offered.iter().any(|it| it == "when_full") && !offered.iter().any(|it| it == "share"), "{offered:?}");

    let typing = ROVER.replace("{pub: rover.Measurement, doc: Readings.}", "");
    server.open(&document("kind.yaml"), "yaml", &typing);
    let offered = server.complete_behind(&document("kind.yaml"), &typing, "- measurements: ");
    assert!(KINDS.iter().all(|kind| offered.iter().any(|it| it == kind)), "{offered:?}");

    let told = server.hover(&document("good.yaml"), ROVER, "queue");
    assert!(told.contains("How many messages may wait for this gate"), "{told}");
}
