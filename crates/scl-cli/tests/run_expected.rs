//! A program that opens another component than the one that it was started as: an error in the program and in
//! `scl run`.

use crate::system::System;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use std::process::Command;

const TOPOLOGY: &str = "\
system: rover
components:
  - name: sensor
    gates:
      - values: pub
  - name: controller
    gates:
      - values: sub
connections:
  - [sensor.values, controller.values]
";

/// The components that a process opens, and the file with their plan.
const PLAYS: &str = "SCL_TEST_EXPECTED_PLAYS";
const PLAN: &str = "SCL_TEST_EXPECTED_PLAN";

const TEST: &str = "run_expected::swapped_programs_are_an_error_on_both_sides";

/// The rover, whose programs are this test in processes of their own; each entry has more keys, after what it opens.
fn system(entries: &[(&str, &str, &str)]) -> System {
    let program = std::env::current_exe().unwrap();
    let command = format!("[{program:?}, --exact, {TEST}, --nocapture, --test-threads, 2]");
    let entry = |(name, opens, keys): &(&str, &str, &str)| {
        format!("  {name}:\n    command: {command}\n    environment: {{{PLAYS}: {opens:?}, {PLAN}: plan.json}}\n{keys}")
    };
    let launch = format!("components:\n{}", entries.iter().map(entry).collect::<String>());
    let system = System::of_files(&[("topology.yaml", TOPOLOGY), ("launch.yaml", &launch)]);
    system.write("drone.yaml", &TOPOLOGY.replace("rover", "drone"));
    for (file, plan) in [("topology.yaml", "plan.json"), ("drone.yaml", "drone.json")] {
        let output = system.scl(&["plan", file]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        system.write(plan, &String::from_utf8(output.stdout).unwrap());
    }
    system
}

/// Opens components, one after the other.
fn play(names: &str) {
    let plan = std::fs::read_to_string(std::env::var(PLAN).unwrap()).unwrap();
    let plan = SystemPlan::from_json(&plan).unwrap();
    for name in names.split(' ') {
        match Component::open_blocking(plan.component(name).unwrap()) {
            Ok(_component) => println!("opened {name}"),
            Err(error) => {
                eprintln!("error: {error}");
                std::process::exit(1);
            }
        }
    }
}

fn run(system: &System) -> (Option<i32>, String, String) {
    let output = system.run(&["launch.yaml"]);
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

const IN_PROGRAM: &str = "sensor | error: component `controller` of system `rover` was not expected: this program was started as \
                          `sensor` of system `rover`; correct its command in the launch file, or allow it there with \
                          `opens: [controller]`\n";

#[test]
fn swapped_programs_are_an_error_on_both_sides() {
    if let Ok(names) = std::env::var(PLAYS) {
        return play(&names);
    }
    let system = system(&[("sensor", "controller", "    restart: always\n")]);
    let (code, out, err) = run(&system);
    assert!(err.contains(IN_PROGRAM), "{err}");
    assert!(err.contains("sensor  wrong program: `"), "{err}");
    let told = "` opens component `controller` of system `rover`, but was started as `sensor`; its entry is at launch.yaml:2:3\n";
    assert_eq!(err.matches(told).count(), 2, "when it happens and at the end: {err}");
    // Another start would not help.
    assert!(!err.contains("restarting"), "{err}");
    assert!(!out.contains("opened"), "{out}");
    assert_eq!(code, Some(1), "{err}");
}

#[test]
fn a_program_of_the_same_name_from_another_project_is_found() {
    let system = system(&[("sensor", "sensor", "")]);
    let launch = std::fs::read_to_string(system.path("launch.yaml")).unwrap();
    system.write("launch.yaml", &launch.replace("plan.json", "drone.json"));
    let (code, _, err) = run(&system);
    let told =
        "opens component `sensor` of system `drone`, but was started as `sensor`; its entry is at launch.yaml:2:3\n";
    assert!(err.contains(told), "{err}");
    assert_eq!(code, Some(1), "{err}");
}

#[test]
fn a_program_may_open_what_its_entry_allows() {
    for (opens, keys) in [
        ("sensor", ""),
        ("sensor controller", "    opens: [controller]\n"),
        ("controller sensor controller", "    opens: any\n"),
    ] {
        let system = system(&[("sensor", opens, keys)]);
        let (code, out, err) = run(&system);
        for name in opens.split(' ') {
            assert!(out.contains(&format!("opened {name}\n")), "{out}{err}");
        }
        assert_eq!(code, Some(0), "{err}");
    }
    let system = system(&[("sensor", "sensor", "    opens: [controler]\n")]);
    let (code, _, err) = run(&system);
    assert!(err.contains("error: [SCL1205] unknown component `controler`\n"), "{err}");
    assert!(err.contains("  = help: did you mean `controller`?\n"), "{err}");
    assert_eq!(code, Some(2), "{err}");
}

#[test]
fn the_variable_of_an_entry_wins() {
    let system = system(&[("sensor", "controller", "")]);
    let launch = std::fs::read_to_string(system.path("launch.yaml")).unwrap();
    for (expected, is_allowed) in [("''", true), ("rover.controller", true), ("rover.gps", false)] {
        let variable = format!("environment: {{SCL_COMPONENT: {expected}, ");
        system.write("launch.yaml", &launch.replace("environment: {", &variable));
        let (code, out, err) = run(&system);
        assert_eq!(
            (code == Some(0), out.contains("opened controller\n")),
            (is_allowed, is_allowed),
            "{expected}: {err}"
        );
    }
}

#[test]
fn what_is_expected_of_one_program_is_not_expected_of_a_run_that_it_starts() {
    let system = system(&[("controller", "controller", "")]);
    let mut inner = system.scl(&["run", "launch.yaml"]);
    let output = inner.env("SCL_COMPONENT", "rover.sensor").output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_program_that_is_started_by_hand_opens_what_it_likes() {
    let system = system(&[]);
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", TEST, "--nocapture"]).current_dir(system.path("")).env_remove("SCL_COMPONENT");
    command.env("SCL_RUNTIME_DIR", system.path("runtime")).env(PLAYS, "sensor controller").env(PLAN, "plan.json");
    let output = command.output().unwrap();
    let out = String::from_utf8(output.stdout).unwrap();
    assert!(out.contains("opened sensor\nopened controller\n"), "{out}");
}
