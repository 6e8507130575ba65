//! Counterparts for unit tests: their text in each language, names that clash with theirs, and a program in C that uses
//! them. Those in C++ and Python are tested beside their bindings.

use crate::c::Project;
use crate::fixture::{clashes, clashes_of_testable, repository, testable, text, topology};
use expect_test::{expect, expect_file};
use scl_generate::Target;
use scl_tests::{Compile, System};
use std::path::Path;

#[test]
fn counterparts_have_the_opposite_gates() {
    let path = topology("testable.yaml");
    let files = testable(&path, Target::C);
    expect_file!["../expected/testable_scl.h"].assert_eq(&text(&files, "testable_scl.h"));
    expect_file!["../expected/testable_scl.c"].assert_eq(&text(&files, "testable_scl.c"));
    let header = text(&testable(&path, Target::Cpp), "testable.scl.hpp");
    expect_file!["../expected/testable.scl.hpp"].assert_eq(&header);
    let module = text(&testable(&path, Target::Python), "testable_scl.py");
    expect_file!["../python/expected/testable_scl.py"].assert_eq(&module);
}

/// Their programs are in `tests/languages/motors`.
#[test]
fn a_kind_becomes_one_type() {
    let path = repository().join("tests/topologies/motors.yaml");
    let files = testable(&path, Target::C);
    expect_file!["../expected/motors_scl.h"].assert_eq(&text(&files, "motors_scl.h"));
    expect_file!["../expected/motors_scl.c"].assert_eq(&text(&files, "motors_scl.c"));
    let header = text(&testable(&path, Target::Cpp), "motors.scl.hpp");
    expect_file!["../expected/motors.scl.hpp"].assert_eq(&header);
    let module = text(&testable(&path, Target::Python), "motors_scl.py");
    expect_file!["../python/expected/motors_scl.py"].assert_eq(&module);
}

#[test]
fn a_program_in_c_tests_a_component() {
    let path = topology("testable.yaml");
    let project = Project::with(&path, &testable(&path, Target::C));
    let program = project.path().join("counterpart");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs/counterpart.c");
    let compile = Compile::c(source).option(format!("-I{}", project.path().display()));
    let generated = ["testable_scl.c", "testable.pb-c.c"].map(|name| project.path().join(name));
    let compile = generated.into_iter().fold(compile, Compile::source);
    let options = ["-pthread", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-lprotobuf-c"];
    options.into_iter().fold(compile, Compile::option).program(&program);

    let system = System::new();
    let exit = system.start(program.to_str().unwrap(), &[]).wait_for_exit();
    // Neither a warning nor a file.
    assert_eq!((exit.code(), exit.output.as_slice(), exit.text().as_str()), (0, &["done".to_owned()][..], "done"));
    assert_eq!(std::fs::read_dir(system.runtime_dir()).unwrap().count(), 0);
}

const SCHEMA: &str = "syntax = \"proto3\"; package rover; message SensorPeer {}";

/// The checker refuses the component `sensor_peer` beside `sensor` (SCL0308), whatever the language. In C, other names
/// may be one, too.
#[test]
fn names_of_a_counterpart_in_c_are_refused() {
    let yaml = "\
system: rover
components:
  - name: motor
    gates:
      - speed: {pub: , unconnected: ok}
      - peer_speed: {sub: , unconnected: ok}
  - name: motor_test
    gates: []
";
    assert_eq!(clashes(yaml, SCHEMA, Target::C), "");
    assert_eq!(clashes_of_testable(yaml, SCHEMA, Target::Cpp), "");
    expect![[r#"
        error: [SCL1102] gate `motor.speed` and gate `motor.peer_speed` would both become `rover_motor_peer_speed_recv` in C
         --> topology.yaml:6:9
          |
        5 |       - speed: {pub: , unconnected: ok}
          |         ----- gate `motor.speed` becomes `rover_motor_peer_speed_recv`
        6 |       - peer_speed: {sub: , unconnected: ok}
          |         ^^^^^^^^^^ becomes `rover_motor_peer_speed_recv`
          |
          = help: rename the gate `motor.peer_speed`
        error: [SCL1102] component `motor` and component `motor_test` would both become `rover_motor_test` in C
         --> topology.yaml:7:11
          |
        3 |   - name: motor
          |           ----- component `motor` becomes `rover_motor_test`
        ...
        7 |   - name: motor_test
          |           ^^^^^^^^^^ becomes `rover_motor_test`
          |
          = help: rename the component `motor_test`
    "#]].assert_eq(&clashes_of_testable(yaml, SCHEMA, Target::C));
}

#[test]
fn a_message_of_the_name_of_a_counterpart_is_refused() {
    let yaml = "\
system: rover
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - values: {pub: rover.SensorPeer, unconnected: ok}
";
    assert_eq!(clashes_of_testable(yaml, SCHEMA, Target::C), "");
    for target in [Target::Cpp, Target::Python] {
        let told = clashes_of_testable(yaml, SCHEMA, target);
        assert!(told.contains("rename the message `rover.SensorPeer`"), "{told}");
    }
}

#[test]
fn a_gate_of_the_name_of_the_test_function_is_refused() {
    let yaml = "\
system: rover
components:
  - name: motor
    gates:
      - test: {pub: , unconnected: ok}
";
    assert_eq!(clashes_of_testable(yaml, SCHEMA, Target::C), "");
    expect![[r#"
        error: [SCL1102] method `test` and gate `motor.test` would both become `test` in class `Motor`
         --> topology.yaml:5:9
          |
        5 |       - test: {pub: , unconnected: ok}
          |         ^^^^ becomes `test`
          |
          = help: rename the gate `motor.test`
    "#]]
    .assert_eq(&clashes_of_testable(yaml, SCHEMA, Target::Python));
    let told = clashes_of_testable(yaml, SCHEMA, Target::Cpp);
    assert!(
        told.contains("function `test` and gate `motor.test` would both become `test` in the C++ struct"),
        "{told}"
    );
}
