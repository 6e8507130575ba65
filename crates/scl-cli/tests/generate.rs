//! `scl generate` as people and build systems run it. What it generates, `scl-generate` tests.

use crate::system::{ChildGuard, SpawnGuarded, System};
use expect_test::{Expect, expect};
use std::process::{Output, Stdio};

const ROVER: &str = "\
system: rover
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement, queue: 1}
connections:
  - [sensor.measurements, controller.sensor]
";
const SCHEMA: &str = "syntax = \"proto3\"; package rover; message Measurement { double speed = 1; }";

fn rover() -> System {
    System::of_files(&[("topology.yaml", ROVER), ("rover.proto", SCHEMA)])
}

fn generate(system: &System, arguments: &[&str]) -> Output {
    system.scl(&[&["generate"], arguments].concat()).output().unwrap()
}

/// Both streams and the exit code.
#[track_caller]
fn check(system: &System, arguments: &[&str], code: i32, expected: Expect) {
    let output = generate(system, arguments);
    let text = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap()).concat();
    expected.assert_eq(&text);
    assert_eq!(output.status.code(), Some(code));
}

#[test]
fn files_are_written_once() {
    let system = rover();
    check(
        &system,
        &["--for", "c", "-o", "gen/rover"],
        0,
        expect![[r#"
            wrote gen/rover/rover_scl.h
            wrote gen/rover/rover_scl.c
        "#]],
    );
    let modified = || std::fs::metadata(system.path("gen/rover/rover_scl.h")).unwrap().modified().unwrap();
    let before = modified();
    check(&system, &["--for", "c", "-o", "gen/rover", "--check"], 0, expect![[""]]);
    check(
        &system,
        &["--for", "c", "-o", "gen/rover"],
        0,
        expect![[r#"
            gen/rover/rover_scl.h is up to date
            gen/rover/rover_scl.c is up to date
        "#]],
    );
    assert_eq!(modified(), before);
}

#[test]
fn counterparts_are_generated_if_asked_for() {
    let system = rover();
    for (target, name, text) in [
        ("c", "rover_scl.h", "scl_status rover_sensor_test(rover_sensor *self, rover_sensor_peer *peer);"),
        ("cpp", "rover.scl.hpp", "struct SensorPeer : ::scl::Component {"),
        ("python", "rover_scl.py", "class SensorPeer(_scl.Counterpart):"),
    ] {
        let generated = |arguments: &[&str], code: i32| {
            let output = generate(&system, &[&["--for", target], arguments].concat());
            assert_eq!(output.status.code(), Some(code), "{target} {arguments:?}: {output:?}");
            std::fs::read_to_string(system.path(name)).unwrap()
        };
        assert!(!generated(&[], 0).contains(text));
        generated(&["--testable", "--check"], 1);
        let testable = generated(&["--testable"], 0);
        assert!(testable.contains(text), "{testable}");
        generated(&["--testable", "--check"], 0);
        generated(&["--check"], 1);
        assert!(!generated(&["--testable", "--component", "controller"], 0).contains(text));
    }
    check(
        &system,
        &["--for", "zmq", "--testable"],
        2,
        expect![[r#"
            error: `--testable` does not go with `--for zmq`, which generates no code
        "#]],
    );
}

#[test]
fn without_a_folder_code_goes_into_the_current_one_and_zmq_to_standard_output() {
    let system = rover();
    for (target, name) in [("c", "rover_scl.h"), ("cpp", "rover.scl.hpp"), ("python", "rover_scl.py")] {
        let output = generate(&system, &["--for", target]);
        assert!(output.status.success() && system.path(name).is_file(), "{output:?}");
    }
    let output = generate(&system, &["--for", "zmq"]);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["components"]["sensor"]["gates"]["measurements"]["zmq_socket_type"], "PUB");
    let yaml = generate(&system, &["--for", "zmq", "--format", "yaml", "--component", "sensor"]).stdout;
    let yaml = String::from_utf8(yaml).unwrap();
    assert!(yaml.contains("\n  sensor:\n") && !yaml.contains("\n  controller:\n"), "{yaml}");
    check(
        &system,
        &["--for", "zmq", "-o", "gen"],
        0,
        expect![[r#"
        wrote gen/rover.zmq.json
    "#]],
    );
}

#[test]
fn check_tells_what_is_not_up_to_date() {
    let system = rover();
    generate(&system, &["--for", "c"]);
    system.write("rover_scl.h", "edited");
    check(
        &system,
        &["--for", "c", "--check"],
        1,
        expect![[r#"
        error: `rover_scl.h` is not up to date
    "#]],
    );
    assert_eq!(std::fs::read_to_string(system.path("rover_scl.h")).unwrap(), "edited");
}

#[test]
fn arguments_without_effect_are_refused() {
    let system = rover();
    check(
        &system,
        &["--for", "c", "--format", "yaml"],
        2,
        expect![[r#"
        error: `--format` is for `--for zmq` only
    "#]],
    );
    check(
        &system,
        &["--for", "zmq", "--depfile", "rover.d"],
        2,
        expect![[r#"
        error: `--depfile` needs a folder: add `-o DIR`
    "#]],
    );
}

#[test]
fn a_kind_is_generated_with_all_of_its_components() {
    let lamps = "\
system: lamps
kinds:
  - {name: lamp, gates: []}
components:
  - {name: red, kind: lamp}
  - {name: white, gates: []}
  - {name: green, kind: lamp}
";
    let system = System::of_files(&[("topology.yaml", lamps)]);
    let classes = |names: &[&str]| {
        let names = names.iter().flat_map(|name| ["--component", name]);
        let arguments: Vec<&str> = ["--for", "python"].into_iter().chain(names).collect();
        assert!(generate(&system, &arguments).status.success());
        let module = std::fs::read_to_string(system.path("lamps_scl.py")).unwrap();
        let plan = module.replace('\n', "");
        let planned = ["red", "white", "green"].map(|name| plan.contains(&format!("{{\"name\": \"{name}\"")));
        let line = module.lines().find(|line| line.starts_with("__all__")).unwrap().to_owned();
        (line, planned)
    };
    assert_eq!(classes(&[]), ("__all__ = [\"Lamp\", \"LampInstance\", \"White\"]".to_owned(), [true; 3]));
    for names in [&["lamp"][..], &["green"], &["green", "lamp"]] {
        let lamp = "__all__ = [\"Lamp\", \"LampInstance\"]".to_owned();
        assert_eq!(classes(names), (lamp, [true, false, true]), "{names:?}");
    }
    assert_eq!(classes(&["white"]), ("__all__ = [\"White\"]".to_owned(), [false, true, false]));
}

#[test]
fn mistakes_are_told_and_nothing_is_written() {
    let system = rover();
    check(
        &system,
        &["--for", "c", "--component", "sensr", "--component", "nobody"],
        1,
        expect![[r#"
            error: system `rover` has no component `sensr`; did you mean `sensor`?
            error: system `rover` has no component `nobody`
        "#]],
    );
    system.write("topology.yaml", &ROVER.replace("controller.sensor]", "controler.sensor]"));
    let output = generate(&system, &["--for", "python"]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("did you mean `controller`"), "{error}");
    assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(1), true));
    let output = generate(&system, &["--for", "python", "nowhere.yaml"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(std::fs::read_dir(system.path("")).unwrap().count(), 2);
}

#[test]
fn a_clash_is_shown_in_the_topology_file() {
    let yaml = "\
system: rover
components:
  - name: motor
    gates: []
  - name: motor-open
    gates: []
";
    let system = System::of_files(&[("topology.yaml", &format!("# scl: allow(SCL0705) an example\n{yaml}"))]);
    let output = generate(&system, &["--for", "c"]);
    let error = String::from_utf8(output.stderr).unwrap();
    let clash = &error[error.find("error:").unwrap()..];
    expect![[r#"
        error: [SCL1102] component `motor` and component `motor-open` would both become `rover_motor_open` in C
         --> topology.yaml:6:11
          |
        4 |   - name: motor
          |           ----- component `motor` becomes `rover_motor_open`
        5 |     gates: []
        6 |   - name: motor-open
          |           ^^^^^^^^^^ becomes `rover_motor_open`
          |
          = help: rename the component `motor-open`

    "#]]
    .assert_eq(clash);
    assert_eq!(output.status.code(), Some(1));
    let checked = system.scl(&["check", "--for", "cpp", "--for", "c"]).output().unwrap();
    let told = String::from_utf8_lossy(&checked.stderr);
    assert!(told.contains(clash.trim_end()), "{told}");
    assert_eq!(checked.status.code(), Some(1));
    let explained = system.scl(&["explain", "SCL1102"]).output().unwrap();
    assert!(explained.status.success());
}

#[test]
fn a_folder_that_cannot_be_written_is_an_error() {
    let system = rover();
    system.write("file", "");
    check(
        &system,
        &["--for", "c", "-o", "file/below"],
        2,
        expect![[r#"
            error: cannot create the folder `file/below`: Not a directory (os error 20)
        "#]],
    );
    check(
        &system,
        &["--for", "c", "-o", "file"],
        2,
        expect![[r#"
        error: cannot create the folder `file`: File exists (os error 17)
    "#]],
    );
}

#[test]
fn build_systems_learn_what_a_file_depends_on() {
    let system = System::of_files(&[("a folder/topology.yaml", ROVER), ("a folder/rover.proto", SCHEMA)]);
    generate(&system, &["--for", "c", "a folder/topology.yaml", "-o", "gen", "--depfile", "gen/rover.d"]);
    expect![[r#"
        gen/rover_scl.h: a\ folder/topology.yaml a\ folder/rover.proto
    "#]]
    .assert_eq(&std::fs::read_to_string(system.path("gen/rover.d")).unwrap());
}

/// Every program of a system may generate when it is built or started.
#[test]
fn any_number_of_programs_generate_into_one_folder_at_once() {
    let system = rover();
    let start = || -> Vec<ChildGuard> {
        let one = || {
            let arguments = ["generate", "--for", "c", "-o", "gen"];
            system.scl(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn_guarded()
        };
        (0..16).map(|_| one()).collect()
    };
    let finish = |processes: Vec<ChildGuard>| -> usize {
        let outputs = processes.into_iter().map(|process| process.wait_with_output());
        let written = |output: Output| {
            assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
            String::from_utf8(output.stdout).unwrap().matches("wrote").count()
        };
        outputs.map(written).sum()
    };
    let alone = rover();
    generate(&alone, &["--for", "c", "-o", "gen"]);
    let expected = std::fs::read_to_string(alone.path("gen/rover_scl.c")).unwrap();
    let processes = start();
    // A reader meets no file, or all of it.
    while !system.path("gen/rover_scl.c").exists() {
        std::thread::yield_now();
    }
    assert_eq!(std::fs::read_to_string(system.path("gen/rover_scl.c")).unwrap(), expected);
    assert!(finish(processes) >= 2);
    assert_eq!(std::fs::read_dir(system.path("gen")).unwrap().count(), 2, "temporary files are left");
    assert_eq!(finish(start()), 0);
}
