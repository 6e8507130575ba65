//! Files that become groups.

use super::*;

const ARM: &str = "\
kinds:
  - {name: joint, gates: [{angle: {pub: Angle}}]}
components:
  - {name: planner, gates: [{command: {sub: Command}}, {path: {pub: Path}}, {angles: {sub: Angle}}]}
  - {name: driver, gates: [{path: {sub: Path}}]}
  - {name: elbow, kind: joint}
  - {name: wrist, kind: joint}
connections:
  - [planner.path, driver.path]
  - [each joint.angle, planner.angles]
exports: {command: planner.command}
";

const MAIN: &str = "\
system: rover
include:
  - {file: parts/arm.yaml, as: left_arm}
  - {file: parts/arm.yaml, as: right_arm}
components:
  - {name: controller, gates: [{left: {pub: Command}}, {right: {pub: Command}}]}
connections:
  - [controller.left, left_arm.command]
  - [controller.right, right_arm.command]
";

/// The problems of these files, beside `arm.yaml`, in short.
fn told(main: &str, arm: &str) -> String {
    let loaded = load_from(&folder(&[("t.yaml", main), ("parts/arm.yaml", arm)]), "t.yaml");
    assert_eq!(loaded.topology.is_none(), !errors(&loaded).is_empty());
    let told = loaded.diagnostics.iter().filter(|problem| problem.severity != Severity::Lint);
    let told = told.map(|problem| {
        let at = problem.primary.as_ref().map(|label| loaded.sources.place(label.span)).unwrap_or_default();
        let helps: Vec<_> = problem.shown_helps().map(|help| help.text()).collect();
        format!("{at} {} {} [{}]\n", problem.code(), problem.message, helps.join(" | "))
    });
    told.collect()
}

#[test]
fn a_file_becomes_several_groups() {
    let loaded = load_from(&folder(&[("t.yaml", MAIN), ("parts/arm.yaml", ARM)]), "t.yaml");
    assert_eq!(rendered(&loaded), "");
    let topology = loaded.topology.unwrap();
    let types: Vec<_> = topology.types().map(|of| (of.name(), of.rust_name())).collect();
    assert_eq!(
        types,
        [
            ("controller", "Controller"),
            ("arm.planner", "ArmPlanner"),
            ("arm.driver", "ArmDriver"),
            ("arm.joint", "ArmJoint")
        ]
    );
    let connections: Vec<String> = topology
        .connections()
        .map(|(_, it)| format!("{} -> {}", topology.gate_path(it.source()), topology.gate_path(it.sink())))
        .collect();
    expect![[r#"
        left_arm.planner.path -> left_arm.driver.path
        left_arm.elbow.angle -> left_arm.planner.angles
        left_arm.wrist.angle -> left_arm.planner.angles
        right_arm.planner.path -> right_arm.driver.path
        right_arm.elbow.angle -> right_arm.planner.angles
        right_arm.wrist.angle -> right_arm.planner.angles
        controller.left -> left_arm.planner.command
        controller.right -> right_arm.planner.command"#]]
    .assert_eq(&connections.join("\n"));
}

#[test]
fn a_file_that_becomes_one_group_has_no_kinds() {
    let main = "\
include: [{file: parts/arm.yaml, as: arm}]
components:
  - {name: controller, gates: [{arm: {pub: Command}}]}
connections:
  - [controller.arm, arm.command]
";
    let loaded = load_from(&folder(&[("t.yaml", main), ("parts/arm.yaml", ARM)]), "t.yaml");
    assert_eq!(rendered(&loaded), "");
    let topology = loaded.topology.unwrap();
    let types: Vec<_> = topology.types().map(|of| of.name()).collect();
    assert_eq!(types, ["controller", "arm.planner", "arm.driver", "arm.joint"]);
}

#[test]
fn contracts_do_not_change_in_a_group() {
    let contracts = |main: &str, files: &[(&str, &str)]| {
        let loaded = load_from(&folder(&[&[("t.yaml", main)], files].concat()), "t.yaml");
        let plan = loaded.system_plan().unwrap();
        let gates = plan.components.iter().flat_map(|plan| &plan.gates).map(|gate| gate.contract.clone());
        let mut contracts: Vec<String> = gates.collect();
        contracts.sort();
        contracts
    };
    let alone = contracts(&ARM.replace("exports: {command: planner.command}\n", ""), &[]);
    let main = "include: [{file: arm.yaml, as: arm}]\n";
    assert_eq!(contracts(main, &[("arm.yaml", ARM)]), alone);
}

#[test]
fn groups_are_in_groups() {
    let hand = "components:\n  - {name: finger, gates: [{grip: {sub: Grip}}]}\nexports: {grip: finger.grip}\n";
    let arm = "\
include:
  - {file: hand.yaml, as: hand}
components:
  - {name: planner, gates: [{grip: {pub: Grip}}, {command: {sub: Command}}]}
connections:
  - [planner.grip, hand.grip]
exports: {command: planner.command}
";
    let loaded = load_from(&folder(&[("t.yaml", MAIN), ("parts/arm.yaml", arm), ("parts/hand.yaml", hand)]), "t.yaml");
    assert_eq!(rendered(&loaded), "");
    let topology = loaded.topology.unwrap();
    let names: Vec<&str> = topology.components().map(|(_, component)| component.name()).collect();
    assert_eq!(
        names,
        ["controller", "left_arm.planner", "left_arm.hand.finger", "right_arm.planner", "right_arm.hand.finger"]
    );
    let kinds: Vec<&str> = topology.kinds().map(|(_, kind)| kind.name()).collect();
    assert_eq!(kinds, ["arm.planner", "hand.finger"]);
}

#[test]
fn a_problem_of_a_file_in_several_groups_is_told_once() {
    let changed = [
        ("planner.path, driver", "plannr.path, driver"),
        ("driver.path]", "driver.pth]"),
        ("{command: {sub", "{command: {sbu"),
        ("- [planner.path, driver.path]", "- [planner.path, planner.command]"),
        ("each joint.angle", "each joint.angel"),
        ("kind: joint}", "kind: jiont}"),
        ("name: driver", "name: planner"),
        ("name: driver", "name: left driver"),
        ("  - [planner.path, driver.path]\n", ""),
        ("planner.command}", "planner.comand}"),
    ];
    let all: String =
        changed.iter().map(|(old, new)| format!("{new}\n{}", told(MAIN, &ARM.replacen(old, new, 1)))).collect();
    expect![[r#"
        plannr.path, driver
        parts/arm.yaml:9:6 SCL0501 unknown component `plannr` [did you mean `planner`?]
        driver.pth]
        parts/arm.yaml:9:27 SCL0502 component `driver` has no gate `pth` [did you mean `path`? | or rename the gate `path` to `pth`]
        {command: {sbu
        parts/arm.yaml:4:40 SCL0401 unknown gate kind `sbu` [the kind is called `sub`]
        - [planner.path, planner.command]
        parts/arm.yaml:5:29 SCL0702 gate `driver.path` is not connected; it will never receive a message [add the connection `[planner.path, driver.path]` | or write `unconnected: ok`, if that is intended]
        parts/arm.yaml:9:5 SCL0601 the two ends of this connection use different message types [write `Command` at `planner.path`]
        parts/arm.yaml:9:5 SCL0509 component `planner` subscribes to its own messages [keep the value in the component, and remove this connection and the gates `planner.path` and `planner.command`]
        each joint.angel
        parts/arm.yaml:10:6 SCL1308 kind `joint` has no gate `angel` [write `each joint.angle` | or rename the gate to `angel`]
        kind: jiont}
        parts/arm.yaml:6:25 SCL1301 unknown kind `jiont` [did you mean `joint`?]
        name: planner
        parts/arm.yaml:5:12 SCL0301 component `planner` is declared twice [rename the second one to `driver`, which the connections name]
        name: left driver
        parts/arm.yaml:5:12 SCL0303 a component name cannot contain a space []

        parts/arm.yaml:4:57 SCL0701 nobody subscribes to `planner.path` [add the connection `[planner.path, driver.path]` | or write `unconnected: ok`, if that is intended]
        parts/arm.yaml:5:29 SCL0702 gate `driver.path` is not connected; it will never receive a message [add the connection `[planner.path, driver.path]` | or write `unconnected: ok`, if that is intended]
        planner.comand}
        parts/arm.yaml:11:20 SCL1605 no component has the gate `planner.comand` [write `planner.command`]
    "#]].assert_eq(&all);
}

#[test]
fn only_exports_are_reached_from_outside() {
    let ends = [
        "left_arm.comand",
        "left_arm.planner.command",
        "left_arm.driver.path",
        "left_arm",
        "left_arm.planner",
        "left.command",
        "arm.command",
        "planner.command",
        "each arm.planner.command",
    ];
    let all: String =
        ends.iter().map(|end| format!("{end}\n{}", told(&MAIN.replacen("left_arm.command", end, 1), ARM))).collect();
    expect![[r#"
        left_arm.comand
        t.yaml:8:23 SCL1604 group `left_arm` does not export `comand` [write `left_arm.command`]
        left_arm.planner.command
        t.yaml:8:23 SCL1604 group `left_arm` does not export `planner.command` [write `left_arm.command`]
        left_arm.driver.path
        t.yaml:8:23 SCL1604 group `left_arm` does not export `driver.path` [add it to the `exports` of the file: `exports: {path: driver.path}`]
        left_arm
        t.yaml:8:23 SCL1604 `left_arm` is a group, not a gate [write `left_arm.command`]
        left_arm.planner
        t.yaml:8:23 SCL1604 group `left_arm` does not export `planner` [the section `exports` of the file names the gates that can be connected]
        left.command
        t.yaml:8:23 SCL1607 unknown component or group `left` [write `left_arm.command`]
        arm.command
        t.yaml:8:23 SCL1607 unknown component or group `arm` [write `left_arm.command` or `right_arm.command`]
        planner.command
        t.yaml:8:23 SCL1607 unknown component or group `planner` [write `left_arm.command` or `right_arm.command`]
        each arm.planner.command
        t.yaml:8:23 SCL1604 `each arm.planner` reaches into groups [export the gate, and connect it for each group]
    "#]].assert_eq(&all);
}

#[test]
fn names_of_groups_may_be_taken() {
    let changed = [
        ("as: right_arm", "as: left_arm"),
        ("as: right_arm", "as: arm"),
        ("as: right_arm", "as: controller"),
        ("as: right_arm", "as: right arm"),
        ("as: right_arm", "as:"),
        ("as: right_arm", "with: right_arm"),
        ("file: parts/arm.yaml, as: right_arm", "path: parts/arm.yaml, as: right_arm"),
        ("file: parts/arm.yaml, as: right_arm", "fiel: parts/arm.yaml, as: right_arm"),
        ("file: parts/arm.yaml, as: right_arm", "as: right_arm"),
        ("{file: parts/arm.yaml, as: right_arm}", "{file: t.yaml, as: right_arm}"),
        ("[controller.right, right_arm.command]", "[controller.right, left_arm.command]"),
        ("  - [controller.left, left_arm.command]\n  - [controller.right, right_arm.command]\n", "  []\n"),
        ("  - {name: controller", "  - {name: ankle, kind: arm.joint}\n  - {name: controller"),
    ];
    let all: String =
        changed.iter().map(|(old, new)| format!("{new}\n{}", told(&MAIN.replacen(old, new, 1), ARM))).collect();
    expect![[r#"
        as: left_arm
        t.yaml:4:32 SCL1601 two groups are called `left_arm` [give each group a name of its own]
        as: arm
        t.yaml:4:32 SCL1601 group `arm` has the name of its file, which becomes several groups [give the group another name]
        as: controller
        t.yaml:4:32 SCL1601 group `controller` has the name of a component [give one of the two another name]
        as: right arm
        t.yaml:4:32 SCL1602 `right arm` cannot be the name of a group [write `right_arm`]
        as:
        t.yaml:4:28 SCL0110 the name of the group is empty [a value follows the colon]
        with: right_arm
        t.yaml:4:28 SCL1602 unknown key `with` in an entry of `include` [write `as`]
        path: parts/arm.yaml, as: right_arm
        t.yaml:4:6 SCL1602 unknown key `path` in an entry of `include` [write `file`]
        fiel: parts/arm.yaml, as: right_arm
        t.yaml:4:6 SCL1602 unknown key `fiel` in an entry of `include` [write `file`]
        as: right_arm
        t.yaml:4:5 SCL1602 an entry of `include` names no file [write `file:` and the path, or the path alone]
        {file: t.yaml, as: right_arm}
        t.yaml:4:12 SCL1502 `t.yaml` includes itself [remove the entry: a file cannot be a group in itself]
        [controller.right, left_arm.command]
        parts/arm.yaml:4:30 SCL0702 gate `right_arm.planner.command` is not connected; it will never receive a message [or write `unconnected: ok`, if that is intended]
          []

        t.yaml:6:12 SCL0705 component `controller` is not connected to anything [each gate has a connection or the option `unconnected: ok`]
        parts/arm.yaml:11:11 SCL1606 nothing is connected to the export `command` [connect it where the file is included, or remove the entry]
          - {name: ankle, kind: arm.joint}
          - {name: controller
        t.yaml:6:25 SCL1604 the kind `arm.joint` is one of a group [declare the kind in a file of its own, which both files include]
    "#]].assert_eq(&all);
}

#[test]
fn files_of_the_same_name_have_kinds_of_their_own() {
    let file = |name: &str, gate: &str| {
        format!("components:\n  - {{name: {name}, gates: [{{{gate}: {{sub: T}}}}]}}\nexports: {{in: {name}.{gate}}}\n")
    };
    let main = "include:
  - {file: left/arm.yaml, as: l1}
  - {file: left/arm.yaml, as: l2}
  - {file: right/arm.yaml, as: r1}
  - {file: right/arm.yaml, as: r2}
components:
  - {name: pilot, gates: [{out: {pub: T}}]}
connections:
  - [pilot.out, l1.in]
  - [pilot.out, l2.in]
  - [pilot.out, r1.in]
  - [pilot.out, r2.in]
";
    let says = |right: &str, main: &str, expected: Expect| {
        let left = file("planner", "command");
        says(&[("t.yaml", main), ("left/arm.yaml", &left), ("right/arm.yaml", right)], "t.yaml", expected);
    };
    let once = main.replace("  - {file: right/arm.yaml, as: r2}\n", "").replace("  - [pilot.out, r2.in]\n", "");
    says(&file("planner", "orders"), &once, expect![""]);
    says(&file("driver", "orders"), main, expect![""]);
    says(
        &file("planner", "orders"),
        main,
        expect![[r#"
        error: [SCL1601] the files of two groups have a kind `arm.planner`
         --> t.yaml:4:32
          |
        2 |   - {file: left/arm.yaml, as: l1}
          |                               -- the other one
        3 |   - {file: left/arm.yaml, as: l2}
        4 |   - {file: right/arm.yaml, as: r1}
          |                                ^^ one of the groups
          |
          = help: rename one of the files: its name stands before those of its kinds
    "#]],
    );
}

#[test]
fn everyone_is_also_in_groups() {
    let main = MAIN.replace(
        "connections:",
        "  - {name: logger, gates: [{records: {pull: Record}}]}\neveryone:\n  - log: {push: Record, to: logger.records}\nconnections:",
    );
    let loaded = load_from(&folder(&[("t.yaml", &main), ("parts/arm.yaml", ARM)]), "t.yaml");
    assert_eq!(rendered(&loaded), "");
    let topology = loaded.topology.unwrap();
    let to_logger = topology.connections().filter(|(_, it)| topology.gate_path(it.sink()) == "logger.records");
    assert_eq!(to_logger.count(), 9);
    // One in the file of the group is about its components only.
    let arm = ARM.replace("connections:", "everyone:\n  - state: {pub: State, to: driver.states}\nconnections:");
    let arm = arm.replace("{path: {sub: Path}}]", "{path: {sub: Path}}, {states: {sub: State}}]");
    let files = folder(&[("t.yaml", MAIN), ("parts/arm.yaml", &arm)]);
    let loaded = load_from(&files, "t.yaml");
    assert_eq!(rendered(&loaded), "");
    let topology = loaded.topology.unwrap();
    let of = |sink: &str| topology.connections().filter(|(_, it)| topology.gate_path(it.sink()) == sink).count();
    assert_eq!((of("left_arm.driver.states"), of("right_arm.driver.states")), (3, 3));
}

#[test]
fn components_of_groups_are_excepted_with_their_kind() {
    let arm = ARM.replace(
        "connections:",
        "everyone:\n  - state: {push: State, to: driver.states, except: [planner]}\nconnections:",
    );
    let arm = arm.replace("{path: {sub: Path}}]", "{path: {sub: Path}}, {states: {pull: State}}]");
    assert_eq!(told(MAIN, &arm), "");
    // One of several cannot be excepted.
    let with = |except: &str| {
        let logger = "  - {name: logger, gates: [{records: {pull: Record}}]}\n";
        let everyone = format!("everyone:\n  - log: {{push: Record, to: logger.records, except: [{except}]}}\n");
        MAIN.replace("connections:", &format!("{logger}{everyone}connections:"))
    };
    assert_eq!(told(&with("left_arm.planner, right_arm.planner"), ARM), "");
    assert_eq!(told(&with("arm.planner"), ARM), "");
    expect![[r#"
        t.yaml:9:54 SCL1403 `left_arm.planner` is of kind `arm.planner`, whose components all have the same gates [write `arm.planner`: none of them gets the gate]
    "#]].assert_eq(&told(&with("left_arm.planner"), ARM));
}

#[test]
fn very_many_groups_are_refused() {
    let twice = |name: &str| format!("include:\n  - {{file: {name}, as: a}}\n  - {{file: {name}, as: b}}\n");
    let last = "components:\n  - {name: x, gates: [{y: {pub: T, unconnected: ok}}]}\n";
    let names: Vec<String> = (0..16).map(|number| format!("f{number}.yaml")).collect();
    let texts: Vec<String> = names[1..].iter().map(|name| twice(name)).collect();
    let mut files: Vec<(&str, &str)> = names.iter().zip(&texts).map(|(name, text)| (&**name, &**text)).collect();
    files.push((&names[15], last));
    let main = twice("f0.yaml");
    files.push(("t.yaml", &main));
    let loaded = load_from(&folder(&files), "t.yaml");
    expect![[r#"
        error: [SCL1309] the file stands for more than 100000 gates and connections of groups
         --> f14.yaml:2:26
          |
        2 |   - {file: f15.yaml, as: a}
          |                          ^ here the limit is reached
          |
          = help: split the system into several
          = note: `f14.yaml` is included at f13.yaml:2:5, which is included at f12.yaml:2:5, which is included at f11.yaml:2:5, which is included at f10.yaml:2:5, which is included at f9.yaml:2:5, which is included at f8.yaml:2:5, which is included at f7.yaml:2:5, which is included at f6.yaml:2:5, which is included at f5.yaml:2:5, which is included at f4.yaml:2:5, which is included at f3.yaml:2:5, which is included at f2.yaml:2:5, which is included at f1.yaml:2:5, which is included at f0.yaml:2:5, which is included at t.yaml:2:5
    "#]].assert_eq(&rendered(&loaded));
}
