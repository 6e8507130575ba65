//! `scl check --format sarif` and `--format cargo`: what programs read.

use crate::system::System;
use cargo_metadata::diagnostic::DiagnosticLevel;
use cargo_metadata::{CompilerMessage, Message};
use serde_json::{Value, json};

/// One error in a line with letters of two bytes, with a second place and a help.
const WRONG: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub # ü
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurement, controller.sensor]
";

const CLEAN: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
";

fn output(system: &System, arguments: &[&str]) -> (Option<i32>, String) {
    let output = system.scl(&[&["check"], arguments].concat()).output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "only text goes to standard error");
    (output.status.code(), String::from_utf8(output.stdout).unwrap())
}

/// The messages as rust-analyzer reads them: with this very library, line by line.
fn cargo_messages(text: &str) -> Vec<Message> {
    text.lines().map(|line| serde_json::from_str::<Message>(line).unwrap()).collect()
}

fn compiler_messages(messages: Vec<Message>) -> Vec<CompilerMessage> {
    let only = |message| if let Message::CompilerMessage(message) = message { Some(message) } else { None };
    messages.into_iter().filter_map(only).collect()
}

#[test]
fn cargo_messages_point_into_the_topology() {
    let system = System::of_files(&[("my rover/ä.yaml", WRONG), ("Cargo.toml", "")]);
    let (code, text) = output(&system, &["--format", "cargo", "my rover/ä.yaml"]);
    assert_eq!(code, Some(1));
    let messages = cargo_messages(&text);
    let [Message::CompilerArtifact(start), .., Message::BuildFinished(end)] = &messages[..] else { panic!("{text}") };
    assert!(!start.fresh, "a fresh artifact does not make editors forget");
    assert!(!end.success);
    let id = start.package_id.clone();
    let found = compiler_messages(messages);
    assert!(found.iter().all(|message| message.package_id == id));
    let message = &found[0].message;
    assert_eq!((message.level, message.code.as_ref().unwrap().code.as_str()), (DiagnosticLevel::Error, "scl::SCL0502"));
    let span = &message.spans[0];
    assert!(span.is_primary && span.file_name.starts_with('/') && span.file_name.ends_with("/my rover/ä.yaml"));
    assert_eq!((span.line_start, span.column_start, span.column_end), (9, 13, 24));
    assert_eq!(&WRONG[span.byte_start as usize..span.byte_end as usize], "measurement");
    assert_eq!(span.text[0].text, "  - [sensor.measurement, controller.sensor]");
    assert!(message.rendered.as_ref().unwrap().contains(" --> my rover/ä.yaml:9:13\n"));
    assert!(message.children.iter().any(|child| child.level == DiagnosticLevel::Help));
}

#[test]
fn cargo_messages_name_the_nearest_manifest() {
    let system = System::of_files(&[("a/b/topology.yaml", WRONG), ("a/Cargo.toml", ""), ("Cargo.toml", "")]);
    let (_, text) = output(&system, &["--format", "cargo", "a/b/topology.yaml"]);
    let first: Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    assert_eq!(first["manifest_path"], system.path("a/Cargo.toml").canonicalize().unwrap().to_str().unwrap());
}

#[test]
fn a_clean_file_makes_editors_forget() {
    let system = System::of_files(&[("topology.yaml", CLEAN)]);
    let (code, text) = output(&system, &["--format", "cargo"]);
    assert_eq!(code, Some(0));
    let messages = cargo_messages(&text);
    assert!(matches!(&messages[..], [Message::CompilerArtifact(_), Message::BuildFinished(end)] if end.success));
}

#[test]
fn a_missing_file_has_a_place_for_editors() {
    let system = System::of_files(&[]);
    let (code, text) = output(&system, &["--format", "cargo"]);
    assert_eq!(code, Some(2));
    let found = compiler_messages(cargo_messages(&text));
    assert!(found[0].message.spans[0].file_name.ends_with("/topology.yaml"));
}

#[test]
fn sarif_is_one_log_for_all_files() {
    let system = System::of_files(&[("a b.yaml", WRONG), ("clean.yaml", CLEAN)]);
    let (code, text) = output(&system, &["--format", "sarif", "a b.yaml", "clean.yaml", "missing.yaml"]);
    assert_eq!(code, Some(2));
    let log: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&log["version"], log["runs"].as_array().unwrap().len()), (&json!("2.1.0"), 1));
    let results = log["runs"][0]["results"].as_array().unwrap();
    let rules: Vec<_> = results.iter().map(|result| result["ruleId"].as_str().unwrap()).collect();
    assert_eq!(rules, ["SCL0502", "SCL0001"]);
    let place = &results[0]["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "a%20b.yaml");
    let region = json!({ "startLine": 9, "startColumn": 13, "endLine": 9, "endColumn": 24 });
    assert_eq!(place["region"], region);
    assert!(results[0]["message"]["text"].as_str().unwrap().contains("\nhelp: "));
    assert!(!results[0]["relatedLocations"].as_array().unwrap().is_empty());
}

#[test]
fn sarif_of_nothing_is_a_log_without_results() {
    let system = System::of_files(&[("topology.yaml", CLEAN)]);
    let (code, text) = output(&system, &["--format", "sarif"]);
    assert_eq!(code, Some(0));
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap()["runs"][0]["results"], json!([]));
}

#[test]
fn of_many_problems_the_first_are_told() {
    let gates: String = (0..1_200).map(|at| format!("      - x{at}: {{pub: T, queu: 1}}\n")).collect();
    let text = format!("components:\n  - name: a\n    gates:\n{gates}");
    let system = System::of_files(&[("topology.yaml", &text)]);
    let rest = "202 more problems in topology.yaml are not shown";
    let lines = |format| {
        let (code, text) = output(&system, &["--format", format]);
        assert_eq!(code, Some(1), "{format}");
        text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()).collect::<Vec<_>>()
    };
    let json = lines("json");
    assert_eq!(json.len(), 1_001);
    assert_eq!((&json[1_000]["code"], &json[1_000]["message"]), (&json!("SCL0008"), &json!(rest)));
    let cargo: Vec<Value> = lines("cargo").into_iter().filter(|it| it["reason"] == "compiler-message").collect();
    assert_eq!(cargo.len(), 1_001);
    assert!(cargo[1_000]["message"]["rendered"].as_str().unwrap().contains(rest));
    let sarif: Value = serde_json::from_str(&output(&system, &["--format", "sarif"]).1).unwrap();
    let results = sarif["runs"][0]["results"].as_array().unwrap();
    assert_eq!((results.len(), &results[1_000]["ruleId"]), (1_001, &json!("SCL0008")));
    for command in ["check", "graph", "generate --for c"] {
        let output = system.scl(&command.split(' ').collect::<Vec<_>>()).output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains("error: [SCL0008]") && text.contains(" not shown"), "{command}: {text}");
        assert_eq!(output.status.code(), Some(1), "{command}");
        assert_eq!(text.contains("topology.yaml: 1200 errors, 2 warnings"), command == "check", "{command}");
    }
}
