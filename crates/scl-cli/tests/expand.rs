//! What `scl expand` prints.

use crate::system::System;
use expect_test::{Expect, expect};

const TOPOLOGY: &str = "\
# Two motors.
system: rover
codec: json
kinds:
  - name: motor
    doc: One motor with its controller.
    optional: true
    memory: 8GiB
    parameters:
      - pin: u8
      - gain: {f64: 0.8, range: [0, 10], unit: 1/s}
      - label: {text: '5', doc: 'a, b'}
      - mode: {one_of: [manual, auto], default: manual}
      - offsets: {list: f64, length: 2, default: [0, 1.5]}
      - limit: {duration: , range: [1ms, 1s]}
    gates:
      - setpoint: {sub: rover.Setpoint, queue: 1, when_full: drop_oldest}
      - state: {pub: rover.MotorState, doc: 'yes', latched: true}
      - raw: pub
x-own: 1
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor, optional: false, memory: 9GiB, doc: 'The other: it turns.'}
  - name: controller
    gates:
      - motors: {pub: rover.Setpoint}
      - states: {sub: , queue: 10}
      - raw: sub
connections:
  - [controller.motors, each motor.setpoint]
  - [each motor.state, controller.states]
  - [left_motor.raw, controller.raw]
  - [right_motor.raw, controller.raw]
";

#[track_caller]
fn check(topology: &str, expected_code: i32, expected_out: &Expect, expected_err: &Expect) {
    let system = System::of_files(&[("topology.yaml", topology)]);
    let output = system.scl(&["expand"]).output().unwrap();
    expected_out.assert_eq(&String::from_utf8(output.stdout).unwrap());
    expected_err.assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(expected_code));
}

#[test]
fn components_in_groups_keep_their_names() {
    let system = System::of_files(&[(
        "topology.yaml",
        "components:\n  - {name: arm.planner, gates: [{path: pub}]}\n  - \
        {name: arm.driver, gates: [{path: sub}]}\nconnections:\n  - [arm.planner.path, arm.driver.path]\n",
    )]);
    let output = system.scl(&["expand"]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("- name: arm.planner\n") && text.contains("- - arm.planner.path\n  - arm.driver.path\n"),
        "{text}"
    );
}

#[test]
fn a_topology_is_printed_without_kinds() {
    check(
        TOPOLOGY,
        0,
        &expect![[r#"
            system: rover
            codec: json
            components:
            - name: left_motor
              doc: One motor with its controller.
              optional: true
              memory: 8GiB
              parameters:
              - pin: u8
              - gain:
                  f64: 0.8
                  range:
                  - 0
                  - 10
                  unit: 1/s
              - label:
                  text: 5
                  doc: a, b
              - mode:
                  one_of:
                  - manual
                  - auto
                  default: manual
              - offsets:
                  list: f64
                  length: 2
                  default:
                  - 0
                  - 1.5
              - limit:
                  duration: null
                  range:
                  - 1ms
                  - 1s
              gates:
              - setpoint:
                  sub: rover.Setpoint
                  queue: 1
                  when_full: drop_oldest
              - state:
                  pub: rover.MotorState
                  doc: yes
                  latched: true
              - raw: pub
            - name: right_motor
              doc: 'The other: it turns.'
              memory: 9GiB
              parameters:
              - pin: u8
              - gain:
                  f64: 0.8
                  range:
                  - 0
                  - 10
                  unit: 1/s
              - label:
                  text: 5
                  doc: a, b
              - mode:
                  one_of:
                  - manual
                  - auto
                  default: manual
              - offsets:
                  list: f64
                  length: 2
                  default:
                  - 0
                  - 1.5
              - limit:
                  duration: null
                  range:
                  - 1ms
                  - 1s
              gates:
              - setpoint:
                  sub: rover.Setpoint
                  queue: 1
                  when_full: drop_oldest
              - state:
                  pub: rover.MotorState
                  doc: yes
                  latched: true
              - raw: pub
            - name: controller
              gates:
              - motors:
                  pub: rover.Setpoint
              - states:
                  sub: null
                  queue: 10
              - raw: sub
            connections:
            - - controller.motors
              - left_motor.setpoint
            - - controller.motors
              - right_motor.setpoint
            - - left_motor.state
              - controller.states
            - - right_motor.state
              - controller.states
            - - left_motor.raw
              - controller.raw
            - - right_motor.raw
              - controller.raw
        "#]],
        &expect![[""]],
    );
}

#[test]
fn the_result_means_the_same_and_stays_as_it_is() {
    let system = System::of_files(&[("topology.yaml", TOPOLOGY)]);
    let flat = String::from_utf8(system.scl(&["expand"]).output().unwrap().stdout).unwrap();
    let other = System::of_files(&[("topology.yaml", &flat)]);
    let again = String::from_utf8(other.scl(&["expand"]).output().unwrap().stdout).unwrap();
    assert_eq!(again, flat);
    system.write("flat.yaml", &flat);
    let diff = system.scl(&["diff", "topology.yaml", "flat.yaml"]).output().unwrap();
    let text = String::from_utf8(diff.stdout).unwrap();
    assert_eq!(diff.status.code(), Some(0), "{text}");
}

#[test]
fn a_topology_with_errors_is_not_printed() {
    let wrong = TOPOLOGY.replace("each motor.state", "each moter.state");
    check(
        &wrong,
        1,
        &expect![[""]],
        &expect![[r#"
            error: [SCL1305] `moter` is no kind
              --> topology.yaml:31:6
               |
            31 |   - [each moter.state, controller.states]
               |      ^^^^^^^^^^^^^^^^
               |
               = help: write `each motor.state`
               = note: declared kinds: `motor`

        "#]],
    );
}

#[test]
fn several_files_are_printed_as_one() {
    let (head, connections) = TOPOLOGY.split_at(TOPOLOGY.find("connections:").unwrap());
    let (main, kinds) = head.split_at(head.find("kinds:").unwrap());
    let (kinds, components) = kinds.split_at(kinds.find("x-own:").unwrap());
    let whole = System::of_files(&[("topology.yaml", TOPOLOGY)]);
    let parts = System::of_files(&[
        ("topology.yaml", &format!("{main}include: [parts/wiring.yaml]\n{components}")),
        ("parts/wiring.yaml", &format!("include: [kinds.yaml]\n{connections}")),
        ("parts/kinds.yaml", kinds),
    ]);
    let [whole, parts] = [whole, parts].map(|system| system.scl(&["expand"]).output().unwrap());
    assert_eq!(String::from_utf8_lossy(&parts.stderr), "");
    assert_eq!(String::from_utf8_lossy(&parts.stdout), String::from_utf8_lossy(&whole.stdout));
}
