//! What `scl graph` draws.

use crate::system::System;
use expect_test::{Expect, expect};

/// Has a name that is a word of Mermaid, a component without gates, and gates with and without a type.
const TOPOLOGY: &str = "\
system: rover
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
  - name: end
    gates:
      - sensor: {sub: rover.Measurement}
      - events: pub
      - commands: {rep: rover.Command -> rover.Status}
  - name: user_interface
    gates:
      - events: sub
      - commands: {req: rover.Command -> rover.Status}
  - name: logger
    gates: []
connections:
  - [end.sensor, sensor.measurements]
  - [end.events, user_interface.events]
  - [end.commands, user_interface.commands]
";

#[track_caller]
fn check(topology: &str, arguments: &[&str], expected_code: i32, expected_out: &Expect, expected_err: &Expect) {
    let system = System::of_files(&[("topology.yaml", topology)]);
    let output = system.scl(&[&["graph"], arguments].concat()).output().unwrap();
    expected_out.assert_eq(&String::from_utf8(output.stdout).unwrap());
    expected_err.assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(expected_code));
}

#[test]
fn mermaid_shows_gates_types_and_directions() {
    check(
        TOPOLOGY,
        &[],
        0,
        &expect![[r#"
        flowchart LR
            subgraph c0["sensor"]
                c0g0(["measurements: pub"])
            end
            subgraph c1["end"]
                c1g0(["sensor: sub"])
                c1g1(["events: pub"])
                c1g2(["commands: rep"])
            end
            subgraph c2["user_interface"]
                c2g0(["events: sub"])
                c2g1(["commands: req"])
            end
            c3["logger"]
            c0g0 -->|"rover.Measurement"| c1g0
            c1g1 --> c2g0
            c2g1 <-.->|"rover.Command -#gt; rover.Status"| c1g2
    "#]],
        &expect![[""]],
    );
}

#[test]
fn dot_shows_gates_types_and_directions() {
    check(
        TOPOLOGY,
        &["--format", "dot"],
        0,
        &expect![[r#"
        digraph "rover" {
            rankdir=LR;
            node [shape=plain, fontname="sans-serif"];
            edge [fontname="sans-serif", fontsize=10];
            "sensor" [label=<
                <table border="0" cellborder="1" cellspacing="0" cellpadding="4">
                    <tr><td bgcolor="lightgrey"><b>sensor</b></td></tr>
                    <tr><td port="measurements" align="left">measurements: pub</td></tr>
                </table>>];
            "end" [label=<
                <table border="0" cellborder="1" cellspacing="0" cellpadding="4">
                    <tr><td bgcolor="lightgrey"><b>end</b></td></tr>
                    <tr><td port="sensor" align="left">sensor: sub</td></tr>
                    <tr><td port="events" align="left">events: pub</td></tr>
                    <tr><td port="commands" align="left">commands: rep</td></tr>
                </table>>];
            "user_interface" [label=<
                <table border="0" cellborder="1" cellspacing="0" cellpadding="4">
                    <tr><td bgcolor="lightgrey"><b>user_interface</b></td></tr>
                    <tr><td port="events" align="left">events: sub</td></tr>
                    <tr><td port="commands" align="left">commands: req</td></tr>
                </table>>];
            "logger" [label=<
                <table border="0" cellborder="1" cellspacing="0" cellpadding="4">
                    <tr><td bgcolor="lightgrey"><b>logger</b></td></tr>
                </table>>];
            "sensor":"measurements" -> "end":"sensor" [label="rover.Measurement"];
            "end":"events" -> "user_interface":"events";
            "user_interface":"commands" -> "end":"commands" [label="rover.Command -> rover.Status", style=dashed, dir=both];
        }
    "#]],
        &expect![[""]],
    );
}

const GROUPS: &str = "\
system: rover
components:
  - {name: arm.hand.finger, gates: [{grip: sub}]}
  - {name: pilot, gates: [{grip: pub}]}
  - {name: arm.planner, gates: []}
connections:
  - [pilot.grip, arm.hand.finger.grip]
";

#[test]
fn groups_are_frames() {
    check(
        GROUPS,
        &[],
        0,
        &expect![[r#"
        flowchart LR
            subgraph c1["pilot"]
                c1g0(["grip: pub"])
            end
            subgraph f0["arm"]
                c2["planner"]
                subgraph f1["hand"]
                    subgraph c0["finger"]
                        c0g0(["grip: sub"])
                    end
                end
            end
            c1g0 --> c0g0
    "#]],
        &expect![[""]],
    );
}

#[test]
fn groups_are_clusters_of_graphviz() {
    check(
        GROUPS,
        &["--format", "dot"],
        0,
        &expect![[r#"
            digraph "rover" {
                rankdir=LR;
                node [shape=plain, fontname="sans-serif"];
                edge [fontname="sans-serif", fontsize=10];
                "pilot" [label=<
                    <table border="0" cellborder="1" cellspacing="0" cellpadding="4">
                        <tr><td bgcolor="lightgrey"><b>pilot</b></td></tr>
                        <tr><td port="grip" align="left">grip: pub</td></tr>
                    </table>>];
                subgraph cluster_0 {
                    label="arm";
                    "arm.planner" [label=<
                        <table border="0" cellborder="1" cellspacing="0" cellpadding="4">
                            <tr><td bgcolor="lightgrey"><b>planner</b></td></tr>
                        </table>>];
                    subgraph cluster_1 {
                        label="hand";
                        "arm.hand.finger" [label=<
                            <table border="0" cellborder="1" cellspacing="0" cellpadding="4">
                                <tr><td bgcolor="lightgrey"><b>finger</b></td></tr>
                                <tr><td port="grip" align="left">grip: sub</td></tr>
                            </table>>];
                    }
                }
                "pilot":"grip" -> "arm.hand.finger":"grip";
            }
        "#]],
        &expect![[""]],
    );
}

#[test]
fn a_file_with_errors_is_explained_instead() {
    check(
        "components:\n  - name:sensor\n    gates: []\n",
        &[],
        1,
        &expect![[""]],
        &expect![[r#"
        error: [SCL0103] missing space after `:`
         --> topology.yaml:2:9
          |
        2 |   - name:sensor
          |         ^ YAML reads `name:sensor` as one word
          |
          = help: write `name: sensor`
          = note: the parser notices it only on line 3, where it says "mapping values are not allowed in this context"

    "#]],
    );
}

#[test]
fn a_file_that_is_not_there_is_named() {
    check(
        TOPOLOGY,
        &["other.yaml"],
        2,
        &expect![[""]],
        &expect![[r#"
        error: [SCL0001] cannot find the topology file `other.yaml`

    "#]],
    );
}
