//! What kinds become, and what is said about mistakes with them.

use super::{OWN_GATES, REPEATED, UNUSED, each, unknown};
use crate::check::testing::{advice, codes, example, rule_example, topology};
use crate::resolve::resolve;
use expect_test::expect;

const ROVER: &str = "\
system: rover
kinds:
  - name: motor
    optional: true
    gates:
      - setpoint: {sub: Setpoint, queue: 1}
      - state: {pub: MotorState}
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor, optional: false}
  - name: controller
    gates:
      - motors: {pub: Setpoint}
      - states: {sub: MotorState}
connections:
  - [controller.motors, each motor.setpoint]
  - [each motor.state, controller.states]
";

/// The same without a kind.
const WRITTEN_OUT: &str = "\
system: rover
components:
  - name: left_motor
    optional: true
    gates:
      - setpoint: {sub: Setpoint, queue: 1}
      - state: {pub: MotorState}
  - name: right_motor
    gates:
      - setpoint: {sub: Setpoint, queue: 1}
      - state: {pub: MotorState}
  - name: controller
    gates:
      - motors: {pub: Setpoint}
      - states: {sub: MotorState}
connections:
  - [controller.motors, left_motor.setpoint]
  - [controller.motors, right_motor.setpoint]
  - [left_motor.state, controller.states]
  - [right_motor.state, controller.states]
";

fn plans(yaml: &str) -> Vec<scl_plan::Plan> {
    let topology = topology(yaml);
    topology.components().map(|(id, _)| resolve(&topology, id, &|_| String::new())).collect()
}

#[test]
fn a_kind_is_the_same_as_its_components_written_out() {
    assert_eq!(plans(ROVER), plans(WRITTEN_OUT));
}

#[test]
fn a_topology_knows_the_components_of_a_kind() {
    let topology = topology(ROVER);
    let kinds: Vec<_> = topology.kinds().collect();
    let [(id, motor)] = kinds.as_slice() else { panic!("{kinds:?}") };
    let names: Vec<&str> = motor.components().iter().map(|id| topology.component(*id).name()).collect();
    assert_eq!((motor.name(), motor.rust_name(), names), ("motor", "Motor", vec!["left_motor", "right_motor"]));
    let kinds: Vec<_> = topology.components().map(|(_, component)| component.kind()).collect();
    assert_eq!(kinds, [Some(*id), Some(*id), None]);
}

#[test]
fn components_of_a_kind_can_be_connected_one_by_one() {
    let alone = ROVER
        .replace("each motor.state", "left_motor.state")
        .replace("pub: MotorState", "pub: MotorState, unconnected: ok");
    assert_eq!(plans(&alone)[1].gates[1].connections, []);
    assert_eq!(codes(&alone), [""; 0]);
}

#[test]
fn unknown_kind() {
    rule_example(
        &unknown::RULE,
        expect![[r#"
        error: [SCL1301] unknown kind `moter`
         --> topology.yaml:7:31
          |
        7 |   - {name: right_motor, kind: moter}
          |                               ^^^^^ no kind has this name
          |
          = help: did you mean `motor`?
          = note: declared kinds: `motor`
    "#]],
    );
}

#[test]
fn own_gates() {
    rule_example(
        &OWN_GATES,
        expect![[r#"
        error: [SCL1302] component `left_motor` is of kind `motor` and has gates of its own
         --> topology.yaml:8:5
          |
        2 |   - name: motor
          |           ----- all components of the kind have its gates
        ...
        8 |     gates: []
          |     ^^^^^
          |
          = help: remove `gates`
    "#]],
    );
}

#[test]
fn unused_kind() {
    rule_example(
        &UNUSED,
        expect![[r#"
        warning: [SCL1303] no component is of kind `motor`
         --> topology.yaml:2:11
          |
        2 |   - name: motor
          |           ^^^^^ has no effect
          |
          = help: a component of the kind is an item of `components`: `- {name: motor_1, kind: motor}`
    "#]],
    );
}

#[test]
fn name_of_a_kind_is_taken() {
    rule_example(
        &REPEATED,
        expect![[r#"
        error: [SCL1304] component `motor` has the name of a kind
         --> topology.yaml:6:12
          |
        2 |   - name: motor
          |           ----- the kind
        ...
        6 |   - {name: motor, kind: motor}
          |            ^^^^^ the component
          |
          = help: give the component another name, also in its connections
    "#]],
    );
}

#[test]
fn each_of_no_kind() {
    rule_example(
        &each::NO_KIND,
        expect![[r#"
        error: [SCL1305] `controller` is no kind
          --> topology.yaml:11:24
           |
         7 |   - name: controller
           |           ---------- this is a component
        ...
        11 |   - [each motor.state, each controller.motors]
           |                        ^^^^^^^^^^^^^^^^^^^^^^
           |
           = help: write `controller.motors`
    "#]],
    );
}

#[test]
fn kind_without_each() {
    rule_example(
        &each::WITHOUT_EACH,
        expect![[r#"
        error: [SCL1306] `motor` is a kind, not a component
          --> topology.yaml:11:6
           |
         2 |   - name: motor
           |           ----- the kind is declared here
        ...
        11 |   - [motor.state, controller.motors]
           |      ^^^^^^^^^^^
           |
           = help: write `each motor.state`
           = note: components of the kind: `left_motor`
    "#]],
    );
}

#[test]
fn each_at_both_ends() {
    rule_example(
        &each::TWICE,
        expect![[r#"
        error: [SCL1307] `each` stands at both ends of the connection
          --> topology.yaml:12:24
           |
        12 |   - [each wheel.speed, each brake.speed]
           |      ----------------  ^^^^^^^^^^^^^^^^ one connection for each
           |      |
           |      and for each
           |
           = help: name the components: one connection for each pair that belongs together
    "#]],
    );
}

#[test]
fn kind_without_the_gate() {
    rule_example(
        &each::NO_GATE,
        expect![[r#"
            error: [SCL1308] kind `motor` has no gate `status`
              --> topology.yaml:11:6
               |
             4 |       - state: {pub: MotorState}
               |         ----- a similar gate is declared here
            ...
            11 |   - [each motor.status, controller.motors]
               |      ^^^^^^^^^^^^^^^^^
               |
               = help: write `each motor.state`
               = help: or rename the gate to `status`
               = note: gates of `motor`: `state`
        "#]],
    );
}

#[test]
fn a_problem_of_all_components_is_told_once() {
    let lonely = ROVER.replace("  - [each motor.state, controller.states]\n", "");
    example(
        "SCL0701",
        &lonely,
        expect![[r#"
            warning: [SCL0701] nobody subscribes to `left_motor.state`
             --> topology.yaml:7:9
              |
            7 |       - state: {pub: MotorState}
              |         ^^^^^ its messages are dropped
              |
              = help: add the connection `[each motor.state, controller.states]`
              = help: or write `unconnected: ok`, if that is intended
              = note: all 2 components of the kind have it: `left_motor`, `right_motor`
        "#]],
    );
    let types = ROVER.replace("sub: MotorState", "sub: Other");
    example(
        "SCL0601",
        &types,
        expect![[r#"
        error: [SCL0601] `controller.states` expects `Other`, but all its senders send `MotorState`
          --> topology.yaml:14:23
           |
         7 |       - state: {pub: MotorState}
           |                      ---------- sent
        ...
        14 |       - states: {sub: Other}
           |                       ^^^^^ expected
           |
           = help: write `MotorState` at `controller.states`
           = note: the other ends agree: `left_motor.state`, `right_motor.state`
    "#]],
    );
}

#[test]
fn what_is_meant_is_proposed() {
    let changes = [
        ("kind: motor}", "kind: Motor}"),
        ("kind: motor}", "type: motor}"),
        ("kind: motor}", "class: motor, gates: []}"),
        ("kind: motor}", "kind: servo}"),
        ("kind: motor}", "kind: }"),
        ("kind: motor}", "kind: [motor]}"),
        ("  - {name: left_motor, kind: motor}", "  - {name: left_motor, kind: motor, gates: [x: pub]}"),
        ("    optional: true\n", "    kind: wheel\n"),
        ("    optional: true\n", "    optinal: true\n"),
        ("kinds:\n  - name: motor", "kinds:\n  motor:"),
        ("kinds:\n", "classes:\n"),
        ("kinds:\n", "kind:\n"),
        ("kinds:\n  - name: motor\n", "kinds:\n  - motor:\n"),
        ("each motor.state", "each moter.state"),
        ("each motor.state", "each motor.stat"),
        ("each motor.state", "each motor"),
        ("each motor.state", "every motor.state"),
        ("each motor.state", "all motor.state"),
        ("each motor.state", "motor.state"),
        ("each motor.state", "motors.state"),
        ("each motor.state, controller.states", "each motor.state controller.states"),
        ("each motor.state, controller.states", "each, motor.state, controller.states"),
        ("[each motor.state, controller.states]", "each motor.state -> controller.states"),
        ("kinds:\n  - name: motor", "kinds:\n  - name: motr"),
        ("kind: motor}", "kind: moto}"),
        ("each motor.state", "each left_motor.state"),
        ("each motor.state", "each.motor.state"),
        ("each motor.state", "each: motor.state"),
        ("each motor.state", "*_motor.state"),
        ("each motor.state", "each  motor.state"),
        ("each motor.state", "Each motor.state"),
        ("each motor.state, controller.states", "each motor.state, each controller.states"),
        ("each motor.state, controller.states", "each motor.state, controller.state"),
        ("each motor.state, controller.states", "each motor.state, each motor.setpoint"),
        (
            "[each motor.state, controller.states]",
            "[each motor.state, controller.states]\n  - [left_motor.state, controller.states]",
        ),
        (
            "[each motor.state, controller.states]",
            "[left_motor.state, controller.states]\n  - [each motor.state, controller.states]",
        ),
        ("name: right_motor", "name: motor"),
        ("name: right_motor", "name: Motor"),
        ("name: right_motor", "name: left_motor"),
        ("  - name: controller", "  - {name: controler, kind: motor}\n  - name: controller"),
    ];
    let told = changes.map(|(from, to)| format!("{to}: {}\n", advice(&ROVER.replacen(from, to, 1)))).concat();
    expect![[r#"
        kind: Motor}: SCL1301 unknown kind `Motor` [did you mean `motor`?]
        type: motor}: SCL0207 unknown key `type` in component `left_motor` [it is written `kind: motor` here]
        class: motor, gates: []}: SCL0207 unknown key `class` in component `left_motor` [`kind` gives a component the gates of one of the `kinds`]
        kind: servo}: SCL1301 unknown kind `servo` [a kind is declared in the section `kinds`, with its gates]
        kind: }: SCL0110 the kind is empty [a value follows the colon | remove `kind`]
        kind: [motor]}: SCL0215 `kind` must be text; this is a list []
          - {name: left_motor, kind: motor, gates: [x: pub]}: SCL1302 component `left_motor` is of kind `motor` and has gates of its own [remove them, if the gates of the kind are meant | or add them to the kind `motor`, or remove `kind: motor`]
            kind: wheel
        : SCL0207 unknown key `kind` in kind `motor` [kinds are not nested: a kind has `gates` of its own]
            optinal: true
        : SCL0207 unknown key `optinal` in kind `motor` [did you mean `optional`?]
        kinds:
          motor:: SCL0204 `kinds` must be a list; this is a mapping [start each kind with its name: `- name: motor`]
        classes:
        : SCL0202 unknown section `classes` [it is called `kinds` here]
        kind:
        : SCL0202 unknown section `kind` [did you mean `kinds`?]
        kinds:
          - motor:
        : SCL0208 this kind has no name [write `- name: motor`]
        each moter.state: SCL1305 `moter` is no kind [write `each motor.state`]
        each motor.stat: SCL1308 kind `motor` has no gate `stat` [write `each motor.state` | or rename the gate to `stat`]
        each motor: SCL1308 which gate of each `motor`? [write `each motor.state`]
        every motor.state: SCL1306 `motor` is a kind, not a component [write `each motor.state`]
        all motor.state: SCL1306 `motor` is a kind, not a component [write `each motor.state`]
        motor.state: SCL1306 `motor` is a kind, not a component [write `each motor.state`]
        motors.state: SCL1306 `motor` is a kind, not a component [write `each motor.state`]
        each motor.state controller.states: SCL0211 a comma is missing between the ends of this connection [write `[each motor.state, controller.states]`]
        each, motor.state, controller.states: SCL0211 a connection joins exactly two gates; this one lists 3 [write `[each motor.state, controller.states]`]
        each motor.state -> controller.states: SCL0211 a connection joins exactly two gates; this one is text [write `[each motor.state, controller.states]`]
        kinds:
          - name: motr: SCL1301 unknown kind `motor` [did you mean `motr`? | or rename the kind to `motor`]
        kind: moto}: SCL1301 unknown kind `moto` [did you mean `motor`?]
        each left_motor.state: SCL1305 `left_motor` is no kind [write `left_motor.state` or `each motor.state`]
        each.motor.state: SCL1306 `motor` is a kind, not a component [write `each motor.state`]
        each: motor.state: SCL0211 an end of a connection is `component.gate`; this is a mapping []
        *_motor.state: SCL0503 a connection end is written `component.gate` [write a connection for each gate: `[left_motor.state, controller.states]`, `[right_motor.state, controller.states]`]
        each  motor.state: 
        Each motor.state: SCL1306 `motor` is a kind, not a component [write `each motor.state`]
        each motor.state, each controller.states: SCL1305 `controller` is no kind [write `controller.states`]
        each motor.state, controller.state: SCL0502 component `controller` has no gate `state` [rename the gate `states` to `state`, as the connections call it]
        each motor.state, each motor.setpoint: SCL1307 `each` stands at both ends of the connection [name the components: one connection for each pair that belongs together]
        [each motor.state, controller.states]
          - [left_motor.state, controller.states]: SCL0510 this connection is already declared [remove one of the two]
        [left_motor.state, controller.states]
          - [each motor.state, controller.states]: SCL0510 this connection is already declared [remove one of the two]
        name: motor: SCL1304 component `motor` has the name of a kind [give the component another name, also in its connections]
        name: Motor: SCL0308 kind `motor` and component `Motor` would both become the Rust type `Motor` [rename one of them, for example `Motor` to `motor_2`]
        name: left_motor: SCL0301 component `left_motor` is declared twice [a component is declared once, with all its gates; another one has another name]
          - {name: controler, kind: motor}
          - name: controller: 
    "#]].assert_eq(&told);
}
