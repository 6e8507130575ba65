//! `scl run` with components of kinds: one entry, or one program of the cargo package, for all of a kind.

use crate::system::{System, without_times};

const TOPOLOGY: &str = "\
system: vehicle
kinds:
  - name: motor
    gates:
      - state: {pub: u32, unconnected: ok}
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor}
connections: []
";

/// Sorted lines of what the programs of a system print.
#[track_caller]
fn printed(files: &[(&str, &str)], arguments: &[&str]) -> Vec<String> {
    let system = System::of_files(&[&[("topology.yaml", TOPOLOGY)], files].concat());
    let run = [&["run"], arguments].concat();
    let output = system.scl(&run).env("CARGO_TARGET_DIR", system.path("target")).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", without_times(&output.stderr));
    let mut lines: Vec<String> = String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect();
    lines.sort_unstable();
    lines
}

#[test]
fn an_entry_of_a_kind_is_that_of_each_of_its_components() {
    let launch = "\
components:
  motor:
    command: echo $SCL_COMPONENT $SIDE
    environment: {SIDE: none}
  right_motor: {environment: {SIDE: right}}
profiles:
  simulation:
    motor: {command: echo simulated $SCL_COMPONENT $SIDE}
    left_motor: {command: echo left}
";
    let files = [("launch.yaml", launch)];
    let all = ["left_motor  | vehicle.left_motor none", "right_motor | vehicle.right_motor right"];
    assert_eq!(printed(&files, &[]), all);
    assert_eq!(printed(&files, &["--only", "right_motor"]), all[1..]);
    let simulated = ["left_motor  | left", "right_motor | simulated vehicle.right_motor right"];
    assert_eq!(printed(&files, &["--profile", "simulation"]), simulated);
}

#[test]
fn the_program_with_the_name_of_a_kind_runs_its_components() {
    let program = |word: &str| {
        format!("fn main() {{ println!(\"{word} {{}}\", std::env::var(\"SCL_COMPONENT\").unwrap_or_default()); }}")
    };
    let (motor, right) = (program("motor"), program("right"));
    let manifest = "[package]\nname = \"vehicle\"\nedition = \"2024\"\n[workspace]\n";
    let files = [("Cargo.toml", manifest), ("src/bin/motor.rs", &motor), ("src/bin/right_motor.rs", &right)];
    let lines = ["left_motor  | motor vehicle.left_motor", "right_motor | right vehicle.right_motor"];
    assert_eq!(printed(&files, &[]), lines);
}
