//! `docs/editor.md` says what works: its settings are taken from the page and used.

use crate::system::{SpawnGuarded, System, kill};
use scl_needs::needs;
use serde_json::Value;
use std::io::Write;
use std::process::{Command, Stdio};

const WRONG: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurement, controller.sensor]
";

/// The JSON blocks of the page.
fn settings() -> Vec<Value> {
    let page = include_str!("../../../../docs/editor.md");
    let blocks = page.split("```json\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    blocks.map(|block| serde_json::from_str(block).unwrap()).collect()
}

/// What the regular expressions of VS Code find in a text, as it reads problems of several lines: each pattern takes
/// the line after the one before.
const MATCH: &str = r#"
const [matcher, text] = JSON.parse(require("fs").readFileSync(0, "utf8"));
const lines = text.split("\n"), found = [];
for (let at = 0; at + 1 < lines.length; at++) {
  const matches = matcher.pattern.map((pattern, next) => new RegExp(pattern.regexp).exec(lines[at + next]));
  if (matches.every(Boolean)) {
    const problem = {};
    matcher.pattern.forEach((pattern, next) => {
      for (const key of Object.keys(pattern).filter(key => key !== "regexp")) problem[key] = matches[next][pattern[key]];
    });
    found.push(problem);
  }
}
for (const key of ["beginsPattern", "endsPattern"]) {
  const pattern = new RegExp(matcher.background[key]);
  found.push(lines.filter(line => pattern.test(line)).length);
}
console.log(JSON.stringify(found));
"#;

#[needs("node")]
#[test]
fn the_task_of_vs_code_finds_the_problems() {
    let task = &settings()[0]["tasks"][0];
    let arguments: Vec<&str> = task["args"].as_array().unwrap().iter().map(|it| it.as_str().unwrap()).collect();
    let system = System::of_files(&[("topology.yaml", WRONG)]);
    let mut watch = system.scl(&arguments);
    let mut watch = watch.stdout(Stdio::null()).stderr(Stdio::piped()).spawn_guarded();
    let text = read_first_check(watch.stderr.take().unwrap());
    kill("-INT", watch.id());
    assert_eq!(watch.wait().unwrap().code(), Some(1));

    let mut node = Command::new("node");
    let mut node = node.args(["-e", MATCH]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn_guarded();
    let input = serde_json::to_string(&(&task["problemMatcher"], &text)).unwrap();
    node.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let found: Value = serde_json::from_slice(&node.wait_with_output().stdout).unwrap();
    let message = "component `sensor` has no gate `measurement`";
    let expected = serde_json::json!([
        { "severity": "error", "code": "SCL0502", "message": message, "file": "topology.yaml", "line": "9", "column": "13" },
        1, 1,
    ]);
    assert_eq!(found, expected, "{text}");
}

fn read_first_check(output: impl std::io::Read) -> String {
    use std::io::BufRead;
    let mut text = String::new();
    let mut lines = std::io::BufReader::new(output);
    while !text.contains("scl: waiting for changes") {
        assert_ne!(lines.read_line(&mut text).unwrap(), 0, "{text}");
    }
    text
}

#[test]
fn the_override_command_gives_cargo_messages() {
    let command = &settings()[1]["rust-analyzer.check.overrideCommand"];
    let words: Vec<&str> = command.as_array().unwrap().iter().map(|it| it.as_str().unwrap()).collect();
    assert_eq!(words[..2], ["sh", "-c"]);
    let (ours, cargo) = words[2].split_once("; ").unwrap();
    assert!(cargo.starts_with("cargo check ") && cargo.ends_with(" --message-format=json"), "{cargo}");
    let system = System::of_files(&[("topology.yaml", WRONG)]);
    let arguments: Vec<&str> = ours.split(' ').skip(1).collect();
    let output = system.scl(&arguments).output().unwrap();
    let messages: Vec<cargo_metadata::Message> = output
        .stdout
        .split(|byte| *byte == b'\n')
        .filter(|line| !line.is_empty())
        .map(|line| serde_json::from_slice(line).unwrap())
        .collect();
    assert!(messages.iter().any(|it| matches!(it, cargo_metadata::Message::CompilerMessage(_))));
}
