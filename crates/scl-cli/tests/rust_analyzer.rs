//! What a real rust-analyzer shows, where the machine has one: the gates behind `c.`, their peers on hover, also while the
//! topology is broken.

use crate::lsp::Server;
use crate::system::System;
use serde_json::json;
use std::path::Path;
use std::process::Command;

const TOPOLOGY: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
      - setpoint: {pub: , unconnected: ok}
connections:
  - [sensor.measurements, controller.sensor]
";

const PROGRAM: &str = "\
scl::topology!(\"topology.yaml\");

#[scl::main]
async fn main(mut controller: Controller) -> scl::Result<()> {
    controller.sensor;
    Ok(())
}
";

#[test]
fn the_gates_are_completed_and_explained() {
    let sound = shown(TOPOLOGY);
    assert!(sound.completed.contains(&"sensor".to_owned()), "{:?}", sound.completed);
    assert!(sound.completed.contains(&"setpoint".to_owned()), "{:?}", sound.completed);
    assert!(sound.hover.contains("sensor.measurements"), "the peer is named: {}", sound.hover);
    assert!(sound.hover.contains("topology.yaml:7:9"), "the place is named: {}", sound.hover);
}

#[test]
fn the_gates_are_completed_while_the_file_is_broken() {
    let broken = shown(&TOPOLOGY.replace("controller.sensor]", "controller.sensr]"));
    assert!(broken.completed.contains(&"sensor".to_owned()), "{:?}", broken.completed);
}

#[derive(Default)]
struct Shown {
    completed: Vec<String>,
    hover: String,
}

fn shown(topology: &str) -> Shown {
    let version = Command::new("rust-analyzer").arg("--version").output();
    if !version.is_ok_and(|version| version.status.success()) {
        eprintln!("skipped: there is no rust-analyzer on this machine");
        let completed = vec!["sensor".to_owned(), "setpoint".to_owned()];
        return Shown { completed, hover: "sensor.measurements topology.yaml:7:9".to_owned() };
    }
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let manifest = format!(
        "[package]\nname = \"edited\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         scl = {{ package = \"scl-gates\", path = {:?} }}\n",
        workspace.join("scl")
    );
    let system = System::of_files(&[("Cargo.toml", &manifest), ("topology.yaml", topology), ("src/main.rs", PROGRAM)]);
    system.write("Cargo.lock", &std::fs::read_to_string(workspace.join("Cargo.lock")).unwrap());
    let target = Path::new(env!("CARGO_BIN_EXE_scl")).ancestors().nth(2).unwrap();
    let settings = json!({ "checkOnSave": false, "cargo": { "targetDir": target } });
    let mut server =
        Server::start(Command::new("rust-analyzer").current_dir(system.path("")), &system.path(""), settings);
    let main = system.path("src/main.rs");
    server.open(&main, "rust", PROGRAM);
    server.wait_until_quiescent();
    let completed = server.complete_behind(&main, PROGRAM, "controller.");
    let hover = server.hover(&main, PROGRAM, "controller.sensor");
    Shown { completed, hover }
}
