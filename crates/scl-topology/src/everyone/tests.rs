use super::{NO_TO, TAKEN, names};
use crate::check::testing::{advice, codes, example, rule_example, topology};
use expect_test::expect;

const ROVER: &str = "\
kinds:
  - name: motor
    gates:
      - state: {pub: MotorState, unconnected: ok}
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor}
  - {name: camera, gates: []}
  - name: sensor
    gates:
      - measurements: {pub: Measurement, unconnected: ok}
  - name: logger
    gates:
      - records: {pull: Record}
everyone:
  - log: {push: Record, to: logger.records, except: [camera]}
connections: []
";

#[test]
fn every_component_gets_the_gate_and_a_connection() {
    let topology = topology(ROVER);
    let paths = topology.connections().map(|(_, connection)| {
        format!("{} - {}", topology.gate_path(connection.source()), topology.gate_path(connection.sink()))
    });
    expect![[r#"
        left_motor.log - logger.records
        right_motor.log - logger.records
        sensor.log - logger.records"#]]
    .assert_eq(&paths.collect::<Vec<_>>().join("\n"));
    let kind = topology.types().next().map(|of| (of.name(), of.component.gates().len()));
    assert_eq!(kind, Some(("motor", 2)), "the components of a kind have the gates of the kind");
}

#[test]
fn no_gate_at_the_other_end() {
    rule_example(
        &NO_TO,
        expect![[r#"
        error: [SCL1401] gate `log` of `everyone` has no `to`
         --> topology.yaml:7:5
          |
        7 |   - log: {push: Record}
          |     ^^^
          |
          = help: `to: logger.records` names the gate at the other end
    "#]],
    );
}

#[test]
fn unknown_gate_at_the_other_end() {
    rule_example(
        &names::UNKNOWN_TO,
        expect![[r#"
        error: [SCL1402] component `logger` has no gate `record`
         --> topology.yaml:7:29
          |
        7 |   - log: {push: Record, to: logger.record}
          |                             ^^^^^^^^^^^^^
          |
          = help: write `logger.records`
          = note: gates of `logger`: `records`
    "#]],
    );
}

#[test]
fn unknown_exception() {
    rule_example(
        &names::UNKNOWN_EXCEPT,
        expect![[r#"
        error: [SCL1403] unknown component `kamera`
         --> topology.yaml:8:54
          |
        8 |   - log: {push: Record, to: logger.records, except: [kamera]}
          |                                                      ^^^^^^
          |
          = help: did you mean `camera`?
    "#]],
    );
}

#[test]
fn needless_exception() {
    rule_example(
        &names::NEEDLESS_EXCEPT,
        expect![[r#"
        warning: [SCL1404] `logger` needs no exception
         --> topology.yaml:7:54
          |
        7 |   - log: {push: Record, to: logger.records, except: [logger]}
          |                                                      ^^^^^^
          |
          = help: remove it: it does not get the gate
    "#]],
    );
}

#[test]
fn gate_of_the_same_name() {
    rule_example(
        &TAKEN,
        expect![[r#"
        error: [SCL1405] `sensor` has a gate `log` of its own
         --> topology.yaml:4:9
          |
        4 |       - log: {pub: Record, unconnected: ok}
          |         ^^^
        ...
        9 |   - log: {push: Record, to: logger.records}
          |     --- `everyone` gives every component one
          |
          = help: rename one of the two, or write `except: [sensor]`
    "#]],
    );
}

#[test]
fn nobody_gets_the_gate() {
    let alone =
        "components:\n  - {name: logger, gates: [records: pull]}\neveryone:\n  - log: {push: , to: logger.records}\n";
    example(
        "SCL1406",
        &format!("{alone}connections: []\n"),
        expect![[r#"
        warning: [SCL1406] no component gets the gate `log`
         --> topology.yaml:4:5
          |
        4 |   - log: {push: , to: logger.records}
          |     ^^^ has no effect
          |
          = help: remove it, or an exception
    "#]],
    );
}

#[test]
fn a_problem_of_all_is_told_once() {
    example(
        "SCL0506",
        &ROVER.replace("{push: Record", "{pub: Record"),
        expect![[r#"
        error: [SCL0506] a `pub` gate cannot be connected to a `pull` gate
          --> topology.yaml:16:5
           |
        14 |       - records: {pull: Record}
           |         ----------------------- takes work, gives no answer
        15 | everyone:
        16 |   - log: {pub: Record, to: logger.records, except: [camera]}
           |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
           |     |
           |     publishes, gets no answer
           |
           = help: make `left_motor.log` a `push` gate
           = help: make `logger.records` a `sub` gate
           = note: pairs that fit: pub - sub, req - rep, push - pull
    "#]],
    );
}

/// What users of other tools write, and what is easily mistyped.
#[test]
fn what_is_meant_is_proposed() {
    let changes = [
        (", to: logger.records", ""),
        ("to: logger.records", "to: logger"),
        ("to: logger.records", "to: loger.records"),
        ("to: logger.records", "to: logger.record"),
        ("to: logger.records", "to: [logger.records]"),
        ("to: logger.records", "to: "),
        ("to: logger.records", "to: motor.state"),
        ("to: logger.records", "to: each motor.state"),
        ("to: logger.records", "to: left_motor.state"),
        ("to: logger.records", "too: logger.records"),
        ("to: logger.records", "to: logger.records, to: logger.records"),
        ("except: [camera]", "exept: [camera]"),
        ("except: [camera]", "except: camera"),
        ("except: [camera]", "except: [kamera]"),
        ("except: [camera]", "except: [left_motor]"),
        ("except: [camera]", "except: [camera, camera]"),
        ("except: [camera]", "except: [logger]"),
        ("except: [camera]", "except: [camera.log]"),
        ("except: [camera]", "except: {camera: yes}"),
        ("  - log: {", "  log: {"),
        ("  - log: {push: Record, to: logger.records, except: [camera]}", "  - log: push"),
        ("everyone:", "evryone:"),
        ("everyone:", "all:"),
        ("- measurements:", "- log:"),
        ("- state:", "- log:"),
        ("connections: []", "connections:\n  - [sensor.log, logger.records]"),
        ("connections: []", "connections:\n  - [each motor.log, logger.records]"),
    ];
    let told = changes.map(|(from, to)| format!("{to}: {}\n", advice(&ROVER.replacen(from, to, 1)))).concat();
    expect![[r#"
        : SCL1401 gate `log` of `everyone` has no `to` [`to: logger.records` names the gate at the other end]
        to: logger: SCL1402 `to` is written `component.gate` [`to` names a gate that a component declares: `logger.records`]
        to: loger.records: SCL1402 unknown component `loger` [write `logger.records`]
        to: logger.record: SCL1402 component `logger` has no gate `record` [write `logger.records`]
        to: [logger.records]: SCL0215 `to` must be text; this is a list []
        to: : SCL0110 the gate in `to` is empty [a value follows the colon]
        to: motor.state: SCL1402 unknown component `motor` [`to` names a gate that a component declares: `logger.records`]
        to: each motor.state: SCL1402 `to` is one gate, not one of each component of a kind [`to` names a gate that a component declares: `logger.records`]
        to: left_motor.state: SCL0506 a `push` gate cannot be connected to a `pub` gate []
        too: logger.records: SCL0212 unknown key `too` in gate `everyone.log` [did you mean `to`?]
        to: logger.records, to: logger.records: SCL0107 the key `to` is written twice in this gate [remove the second one | remove the first one]
        exept: [camera]: SCL0212 unknown key `exept` in gate `everyone.log` [did you mean `except`?]
        except: camera: 
        except: [kamera]: SCL1403 unknown component `kamera` [did you mean `camera`?]
        except: [left_motor]: SCL1403 `left_motor` is of kind `motor`, whose components all have the same gates [write `motor`: none of them gets the gate]
        except: [camera, camera]: 
        except: [logger]: 
        except: [camera.log]: SCL1403 unknown component `camera.log` [did you mean `camera`?]
        except: {camera: yes}: SCL0215 `except` must be text; this is a mapping []
          log: {: SCL0204 `everyone` must be a list; this is a mapping [start each gate with `-`: `- log: ...`]
          - log: push: SCL1401 gate `log` of `everyone` has no `to` [`to: logger.records` names the gate at the other end]
        evryone:: SCL0202 unknown section `evryone` [did you mean `everyone`?]
        all:: SCL0202 unknown section `all` [it is called `everyone` here]
        - log:: SCL1405 `sensor` has a gate `log` of its own [rename one of the two, or write `except: [sensor]`]
        - log:: SCL1405 `motor` has a gate `log` of its own [rename one of the two, or write `except: [motor]`]
        connections:
          - [sensor.log, logger.records]: SCL0510 this connection is already declared [remove one of the two]
        connections:
          - [each motor.log, logger.records]: SCL0510 this connection is already declared [remove one of the two]
    "#]].assert_eq(&told);
}

#[test]
fn a_file_without_other_connections_needs_no_section_for_them() {
    let yaml = "components:\n  - {name: sensor, gates: []}\n  - name: logger\n    gates:\n      - records: pull\n";
    assert_eq!(codes(yaml), ["SCL0206", "SCL0702"]);
    assert!(codes(&format!("{yaml}everyone:\n  - log: {{push: , to: logger.records}}\n")).is_empty());
}
