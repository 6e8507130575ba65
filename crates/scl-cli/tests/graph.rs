//! What `scl graph` draws.

use crate::system::System;
use expect_test::{Expect, expect, expect_file};
use std::path::Path;

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

/// Returns the picture that `scl graph` draws of a topology, without its style.
fn picture(topology: &str, arguments: &[&str]) -> String {
    let system = System::of_files(&[("topology.yaml", topology)]);
    let output = system.scl(&[&["graph", "--format", "svg"], arguments].concat()).output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    let text = String::from_utf8(output.stdout).unwrap();
    let (before, rest) = text.split_once("<style>").unwrap();
    format!("{before}{}", rest.split_once("</style>\n").unwrap().1)
}

/// Returns the texts that a viewer reads in a picture, in the order of the file.
fn texts(picture: &str) -> Vec<&str> {
    let after = picture.split("<text ").skip(1);
    after.map(|it| it.split_once('>').unwrap().1.split_once('<').unwrap().0).collect()
}

/// Returns what a viewer reads who points at the edges.
fn edges(picture: &str) -> Vec<&str> {
    let after = picture.split("<g class=\"edge").skip(1);
    after.map(|it| it.split_once("<title>").unwrap().1.split_once('<').unwrap().0).collect()
}

#[test]
fn a_picture_shows_gates_and_groups() {
    let picture = picture(GROUPS, &[]);
    expect![[r#"
        <svg xmlns="http://www.w3.org/2000/svg" class="scl" role="img" width="384" height="222" viewBox="0 0 384 222">
        <title>rover</title>
        <defs><marker id="arrow" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" markerUnits="userSpaceOnUse" orient="auto-start-reverse"><path class="arrow" d="M0 0.5L8 4L0 7.5Z"/></marker></defs>
        <rect class="ground" width="384" height="222"/>
        <g class="frame"><rect x="154" y="16" width="214" height="190" rx="8"/><text x="163" y="34">arm</text></g>
        <g class="frame"><rect x="202" y="44" width="152" height="92" rx="8"/><text x="211" y="62">hand</text></g>
        <g class="edge"><title>pilot.grip → arm.hand.finger.grip: bytes</title><path class="reach" d="M106 108H154H202H250"/><path d="M106 108H154H202H250" marker-end="url(#arrow)"/></g>
        <g class="block"><title>arm.hand.finger</title><rect class="border" x="250" y="72" width="90" height="50" rx="5"/><text class="name" x="295" y="89.5">finger</text><path class="line" d="M250 98h90"/><text class="gate" x="259" y="112">grip</text><text class="kind right" x="331" y="112">sub</text></g>
        <g class="block"><title>pilot</title><rect class="border" x="16" y="72" width="90" height="50" rx="5"/><text class="name" x="61" y="89.5">pilot</text><path class="line" d="M16 98h90"/><text class="gate right" x="97" y="112">grip</text><text class="kind" x="25" y="112">pub</text></g>
        <g class="block"><title>arm.planner</title><rect class="border" x="154" y="158" width="90" height="34" rx="5"/><text class="name" x="199" y="179.5">planner</text></g>
        </svg>
    "#]].assert_eq(&picture);
}

#[test]
fn a_picture_shows_types_and_directions() {
    let picture = picture(TOPOLOGY, &[]);
    expect![[r#"
        [
            "sensor.measurements → end.sensor: rover.Measurement",
            "end.events → user_interface.events: bytes",
            "user_interface.commands ⇄ end.commands: rover.Command -&gt; rover.Status",
        ]
    "#]]
    .assert_debug_eq(&edges(&picture));
    expect!["sensor, measurements, pub Measurement, end, sensor, sub Measurement, events, pub, commands, rep Command → Status, user_interface, events, sub, commands, req Command → Status, logger"].assert_eq(&texts(&picture).join(", "));
    assert_eq!(picture.matches("class=\"edge asks\"").count(), 1);
    assert_eq!(picture.matches("marker-start").count(), 1);
}

/// A line of components, each of which sends to the next one, and asks it.
fn line(components: usize) -> String {
    let (mut names, mut connections) = (String::new(), String::new());
    for index in 0..components {
        let next = if index + 1 < components { "{next: pub}, {ask: req}, " } else { "" };
        let last = if index > 0 { "{last: sub}, {answer: rep}" } else { "" };
        names.push_str(&format!("  - {{name: c{index}, gates: [{next}{last}]}}\n"));
        if let Some(before) = index.checked_sub(1) {
            let lines = format!("  - [c{before}.next, c{index}.last]\n  - [c{before}.ask, c{index}.answer]\n");
            connections.push_str(&lines);
        }
    }
    format!("system: line\ncomponents:\n{names}connections:\n{connections}")
}

#[test]
fn with_many_components_a_picture_shows_no_gates() {
    let (twelve, thirteen) = (picture(&line(12), &[]), picture(&line(13), &[]));
    assert_eq!(texts(&twelve).iter().filter(|text| **text == "next").count(), 11);
    assert_eq!(edges(&twelve).len(), 22);
    assert_eq!(texts(&thirteen).iter().filter(|text| **text == "next").count(), 0);
    let expected: Vec<String> =
        (1..13).map(|it| format!("c{0}.next → c{it}.last: bytes\nc{0}.ask ⇄ c{it}.answer: bytes", it - 1)).collect();
    assert_eq!(edges(&thirteen), expected);

    assert_eq!(texts(&picture(&line(12), &["--level", "components"])).len(), 12);
    assert_eq!(edges(&picture(&line(13), &["--level", "gates"])).len(), 24);
}

#[test]
fn gates_of_everyone_are_left_out_and_named() {
    let topology = "\
system: logged
components:
  - {name: logger, gates: [{records: {pull: rover.Record}}]}
  - {name: sensor, gates: [{values: pub}]}
  - {name: display, gates: [{values: sub}]}
  - {name: idle, gates: []}
everyone:
  - log: {push: rover.Record, to: logger.records}
connections:
  - [sensor.values, display.values]
";
    let without = picture(topology, &[]);
    expect!["logger, sensor, values, pub, display, values, sub, idle, not drawn: logger.records, connected with every other component"].assert_eq(&texts(&without).join(", "));
    let with = picture(topology, &["--everyone"]);
    assert_eq!(edges(&with).len(), edges(&without).len() + 3);
    assert!(!texts(&with).iter().any(|text| text.starts_with("not drawn")));
}

#[test]
fn options_of_pictures_are_refused_for_text() {
    check(
        TOPOLOGY,
        &["--level", "gates"],
        2,
        &expect![[""]],
        &expect![[r#"
        error: `--level` and `--everyone` are for pictures only
          = help: add `--format svg`
    "#]],
    );
    check(
        TOPOLOGY,
        &["--format", "dot", "--everyone"],
        2,
        &expect![[""]],
        &expect![[r#"
        error: `--level` and `--everyone` are for pictures only
          = help: add `--format svg`
    "#]],
    );
}

/// The pictures in the documentation are those that `scl graph` draws now.
#[test]
fn pictures_of_the_examples_are_up_to_date() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let kept = [
        ("quickstart", expect_file!["../../../examples/quickstart/pictures/system.svg"]),
        ("arcade", expect_file!["../../../examples/arcade/pictures/system.svg"]),
        ("ospecorr", expect_file!["../../../examples/ospecorr/pictures/system.svg"]),
    ];
    for (example, kept) in kept {
        let topology = examples.join(example).join("topology.yaml");
        let arguments = ["graph", "--format", "svg", topology.to_str().unwrap()];
        let output = System::of_files(&[]).scl(&arguments).output().unwrap();
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
        kept.assert_eq(&String::from_utf8(output.stdout).unwrap());
    }
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
