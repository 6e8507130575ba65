//! Names that would be one name in another language.

use crate::fixture::clashes;
use expect_test::expect;
use scl_generate::{Format, Target};

const SCHEMA: &str = "syntax = \"proto3\"; package rover; message Measurement {}";

#[test]
fn gates_of_different_components_become_one_function_of_c() {
    let yaml = "\
system: rover
components:
  - name: a
    gates:
      - b_c: pub
  - name: a_b
    gates:
      - c: pub
  - name: sink
    gates:
      - one: sub
      - other: sub
connections:
  - [a.b_c, sink.one]
  - [a_b.c, sink.other]
";
    let good = yaml.replace("c: pub\n  - name: sink", "d: pub\n  - name: sink").replace("a_b.c", "a_b.d");
    assert_eq!(clashes(&good, SCHEMA, Target::C), "");
    expect![[r#"
        error: [SCL1102] gate `a.b_c` and gate `a_b.c` would both become `rover_a_b_c_send` in C
         --> topology.yaml:8:9
          |
        5 |       - b_c: pub
          |         --- gate `a.b_c` becomes `rover_a_b_c_send`
        ...
        8 |       - c: pub
          |         ^ becomes `rover_a_b_c_send`
          |
          = help: rename the gate `a_b.c`
    "#]]
    .assert_eq(&clashes(yaml, SCHEMA, Target::C));
}

#[test]
fn components_become_one_name_or_a_function_of_c() {
    let yaml = "\
system: rover
components:
  - name: GPSFix
    gates: []
  - name: gps_fix
    gates: []
  - name: motor
    gates: []
  - name: motor_open
    gates: []
";
    expect![[r#"
        error: [SCL1102] component `GPSFix` and component `gps_fix` would both become `rover_gps_fix` in C
         --> topology.yaml:5:11
          |
        3 |   - name: GPSFix
          |           ------ component `GPSFix` becomes `rover_gps_fix`
        4 |     gates: []
        5 |   - name: gps_fix
          |           ^^^^^^^ becomes `rover_gps_fix`
          |
          = help: rename the component `gps_fix`
        error: [SCL1102] component `motor` and component `motor_open` would both become `rover_motor_open` in C
         --> topology.yaml:9:11
          |
        7 |   - name: motor
          |           ----- component `motor` becomes `rover_motor_open`
        8 |     gates: []
        9 |   - name: motor_open
          |           ^^^^^^^^^^ becomes `rover_motor_open`
          |
          = help: rename the component `motor_open`
    "#]]
    .assert_eq(&clashes(yaml, SCHEMA, Target::C));
    assert_eq!(clashes(yaml, SCHEMA, Target::Zmq(Format::Json)), "");
}

#[test]
fn a_component_becomes_the_name_of_a_message_of_c() {
    let yaml = "\
system: rover
schemas: [rover.proto]
components:
  - name: _measurement__init
    gates:
      - values: {pub: rover.Measurement}
  - name: sink
    gates:
      - values: {sub: rover.Measurement}
connections:
  - [_measurement__init.values, sink.values]
";
    expect![[r#"
        error: [SCL1101] message `rover.Measurement` and component `_measurement__init` would both become `rover__measurement__init` in C
         --> topology.yaml:4:11
          |
        4 |   - name: _measurement__init
          |           ^^^^^^^^^^^^^^^^^^ becomes `rover__measurement__init`
        ...
        9 |       - values: {sub: rover.Measurement}
          |                       ----------------- message `rover.Measurement` becomes `rover__measurement__init`
          |
          = help: rename the component `_measurement__init`
    "#]].assert_eq(&clashes(yaml, SCHEMA, Target::C));
}

#[test]
fn a_keyword_and_its_escape_become_one_member() {
    let yaml = "\
system: rover
components:
  - name: teacher
    gates:
      - class: pub
      - class_: pub
  - name: pupil
    gates:
      - one: sub
      - other: sub
connections:
  - [teacher.class, pupil.one]
  - [teacher.class_, pupil.other]
";
    for target in [Target::C, Target::Cpp, Target::Python] {
        let told = clashes(yaml, SCHEMA, target);
        let headline = told.lines().next().unwrap_or_default();
        let expected = "error: [SCL1102] gate `teacher.class` and gate `teacher.class_` would both become `class_` in ";
        assert!(headline.starts_with(expected), "{target:?}: {told}");
    }
}

#[test]
fn a_component_and_a_message_share_the_namespace_of_the_system() {
    let yaml = "\
system: rover
schemas: [rover.proto]
components:
  - name: measurement
    gates:
      - values: {pub: rover.Measurement}
  - name: sink
    gates:
      - values: {sub: rover.Measurement}
connections:
  - [measurement.values, sink.values]
";
    assert_eq!(clashes(yaml, SCHEMA, Target::C), "");
    let told = [Target::Cpp, Target::Python].map(|target| clashes(yaml, SCHEMA, target));
    expect![[r#"
        error: [SCL1101] message `rover.Measurement` and component `measurement` would both become `Measurement` in the C++ namespace `rover`
         --> topology.yaml:4:11
          |
        4 |   - name: measurement
          |           ^^^^^^^^^^^ becomes `Measurement`
        5 |     gates:
        6 |       - values: {pub: rover.Measurement}
          |                       ----------------- message `rover.Measurement` becomes `Measurement`
          |
          = help: rename the component `measurement`
        error: [SCL1101] component `measurement` and message `rover.Measurement` would both become `Measurement` in module `rover_scl`
         --> topology.yaml:4:11
          |
        4 |   - name: measurement
          |           ^^^^^^^^^^^ becomes `Measurement`
        5 |     gates:
        6 |       - values: {pub: rover.Measurement}
          |                       ----------------- message `rover.Measurement` becomes `Measurement`
          |
          = help: rename the component `measurement`
    "#]].assert_eq(&told.concat());
}

#[test]
fn names_of_a_kind_that_are_taken_are_refused() {
    let yaml = "\
system: rover
kinds:
  - name: motor
    gates:
      - instance: {pub: , unconnected: ok}
components:
  - {name: front_left, kind: motor}
  - {name: GPSFix, kind: motor}
  - {name: gps_fix, kind: motor}
  - {name: motor_open_as, gates: []}
  - {name: motor_instance_names, gates: []}
";
    expect![[r#"
        error: [SCL1102] kind `motor` and component `motor_open_as` would both become `rover_motor_open_as` in C
          --> topology.yaml:10:12
           |
         3 |   - name: motor
           |           ----- kind `motor` becomes `rover_motor_open_as`
        ...
        10 |   - {name: motor_open_as, gates: []}
           |            ^^^^^^^^^^^^^ becomes `rover_motor_open_as`
           |
           = help: rename the component `motor_open_as`
        error: [SCL1102] component `GPSFix` and component `gps_fix` would both become `ROVER_MOTOR_INSTANCE_GPS_FIX` in C
         --> topology.yaml:9:12
          |
        8 |   - {name: GPSFix, kind: motor}
          |            ------ component `GPSFix` becomes `ROVER_MOTOR_INSTANCE_GPS_FIX`
        9 |   - {name: gps_fix, kind: motor}
          |            ^^^^^^^ becomes `ROVER_MOTOR_INSTANCE_GPS_FIX`
          |
          = help: rename the component `gps_fix`
        error: [SCL1102] component `motor_instance_names` and kind `motor` would both become `rover_motor_instance_names` in C
          --> topology.yaml:3:11
           |
         3 |   - name: motor
           |           ^^^^^ becomes `rover_motor_instance_names`
        ...
        11 |   - {name: motor_instance_names, gates: []}
           |            -------------------- component `motor_instance_names` becomes `rover_motor_instance_names`
           |
           = help: rename the kind `motor`
    "#]].assert_eq(&clashes(yaml, SCHEMA, Target::C));
    for target in [Target::Cpp, Target::Python] {
        let told = clashes(yaml, SCHEMA, target);
        assert!(told.contains("`instance` and gate `motor.instance` would both become `instance` in "), "{told}");
    }
    let good = yaml.replace("- instance:", "- state:").replace("gps_fix", "rear_left");
    for target in [Target::Cpp, Target::Python] {
        assert_eq!(clashes(&good, SCHEMA, target), "");
    }
    let good = good.replace("motor_open_as", "open_motor").replace("motor_instance_names", "names");
    assert_eq!(clashes(&good, SCHEMA, Target::C), "");
}
