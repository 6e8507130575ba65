//! With the feature `nightly`, rustc reports problems at their positions in the topology file. Each file is compiled in
//! a crate of its own, by a nightly compiler, or without one by the compiler of the tests, which is told to be nightly.
#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

const WRONG_IN_TWO_PLACES: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
      - größe: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.senser]
";

/// Two warnings: a gate without a peer, and a file without connections.
const UNCONNECTED: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
";

const MANIFEST: &str = "[package]\nname = \"spans\"\nedition = \"2024\"\n[workspace]\n[dependencies]\n";

/// What the wrapper macro in `scl` expands to.
const INVOCATION: &str = "scl_macros::__topology! { crate, \"topology.yaml\" }\n";

#[test]
fn problems_are_reported_in_the_topology_file() {
    let wrong =
        ["SCL0304 src/topology.yaml 5:9-14", "SCL0502 src/topology.yaml 10:38-44", "SCL0701 src/topology.yaml 5:9-14"];
    let unconnected = ["SCL0206 src/topology.yaml 1:1-11", "SCL0701 src/topology.yaml 4:9-21"];
    let outside = wrong.map(|mark| mark.replace("src/", "/"));
    let outside: Vec<&str> = outside.iter().map(String::as_str).collect();
    let missing = ["SCL0001 src/lib.rs 1:34-49"];
    let with_bom = format!("\u{feff}{}", WRONG_IN_TWO_PLACES.replace('\n', "\r\n"));
    let cases: [(&str, &str, &[&str]); 5] = [
        ("src/topology.yaml", WRONG_IN_TWO_PLACES, &wrong),
        ("src/topology.yaml", &with_bom, &wrong),
        ("src/topology.yaml", UNCONNECTED, &unconnected),
        ("topology.yaml", WRONG_IN_TWO_PLACES, &outside),
        ("src/other.txt", "", &missing),
    ];
    for (path, text, expected) in cases {
        assert_eq!(marks(path, text), expected, "{path}:\n{text}");
    }
}

/// Code, file, line and columns of the primary spans, when a crate with this file is compiled.
fn marks(path: &str, text: &str) -> Vec<String> {
    let krate = tempfile::tempdir().unwrap();
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = format!("{MANIFEST}scl-macros = {{ path = {here:?}, features = [\"nightly\"] }}\n");
    fs::create_dir(krate.path().join("src")).unwrap();
    fs::write(krate.path().join("Cargo.toml"), manifest).unwrap();
    fs::write(krate.path().join("src/lib.rs"), INVOCATION).unwrap();
    fs::write(krate.path().join(path), text).unwrap();
    // Use the versions of the workspace, so that cargo needs no network.
    fs::copy(here.join("../Cargo.lock"), krate.path().join("Cargo.lock")).unwrap();
    let built = cargo()
        .args(["check", "--offline", "--message-format=json", "--target-dir"])
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join("nightly_spans"))
        .current_dir(krate.path())
        .output()
        .unwrap();
    let lines = String::from_utf8(built.stdout).unwrap();
    let marks: Vec<String> = lines.lines().filter_map(|line| mark(&serde_json::from_str(line).unwrap())).collect();
    assert!(!marks.is_empty(), "{lines}\n{}", String::from_utf8_lossy(&built.stderr));
    marks
}

fn cargo() -> Command {
    let mut asked = Command::new("rustup");
    let mut command = Command::new("rustup");
    command.args(["run", "nightly", "cargo"]).env_remove("RUSTC_BOOTSTRAP");
    if asked.args(["run", "nightly", "rustc", "--version"]).output().is_ok_and(|asked| asked.status.success()) {
        return command;
    }
    let mut command = Command::new(env!("CARGO"));
    command.env("RUSTC_BOOTSTRAP", "1");
    command
}

/// Describes an error of SCL. The crate has other errors, because it has no runtime.
fn mark(message: &Value) -> Option<String> {
    let text = message["message"]["message"].as_str()?;
    let code = &text[text.find("[SCL")? + 1..][..7];
    let span = message["message"]["spans"].as_array()?.iter().find(|span| span["is_primary"] == true)?;
    let file = span["file_name"].as_str()?;
    // Files outside of the source folder have absolute paths.
    let file = if file.starts_with('/') { &file[file.rfind('/')?..] } else { file };
    Some(format!("{code} {file} {}:{}-{}", span["line_start"], span["column_start"], span["column_end"]))
}
