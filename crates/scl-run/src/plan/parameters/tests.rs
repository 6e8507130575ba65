//! Which values programs get, and which are refused before anything is built.

use super::super::{RunPlan, plan_run};
use super::Values;
use crate::Options;
use crate::launch_file::{LaunchComponent, Opens};
use crate::system_names::SystemNames;
use crate::system_names::tests::rover;
use expect_test::expect;
use scl_plan::Assignment;
use scl_terminal::Problem;
use std::path::Path;

fn options(set: &[&str]) -> Options {
    Options { set: set.iter().map(|text| Assignment::parse(text).unwrap()).collect(), ..Options::default() }
}

fn component(name: &str, parameters: &[(&str, &str)]) -> LaunchComponent {
    let parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    LaunchComponent { name: name.to_owned(), parameters, place: "launch.yaml:2:3".to_owned(), ..Default::default() }
}

fn told(problems: &[Problem]) -> String {
    problems.iter().map(ToString::to_string).collect()
}

/// The variable of each of these programs.
fn variables(values: &Values<'_>, programs: &[(&str, Opens)]) -> String {
    let one = |(name, opens): &(&str, Opens)| match values.variable_of(name, opens) {
        Some((variable, value)) => format!("{name}: {variable}={value}\n"),
        None => format!("{name}: no variable\n"),
    };
    programs.iter().map(one).collect()
}

fn launched() -> [LaunchComponent; 4] {
    [
        component("right_motor", &[("pin", "1"), ("pin", "2")]),
        component("left_motor", &[("name", "a, b"), ("pin", "1")]),
        component("controller", &[("mode", "auto"), ("gain", "1")]),
        component("sensor", &[]),
    ]
}

fn programs() -> [(&'static str, Opens); 5] {
    let also = Opens::Also(vec!["controller".to_owned()]);
    let own = Opens::Own;
    [
        ("controller", own.clone()),
        ("left_motor", own.clone()),
        ("right_motor", own),
        ("sensor", also),
        ("x", Opens::Any),
    ]
}

#[test]
fn programs_get_the_values_of_the_components_that_they_may_open_and_of_their_kind() {
    let known = rover();
    let values = Values::new(&options(&[]), None, &launched(), Some(&known)).unwrap();
    expect![[r#"
        controller: SCL_SET=controller.gain=1,controller.mode=auto
        left_motor: SCL_SET=left_motor.pin=1,left_motor.name="a, b",right_motor.pin=2
        right_motor: SCL_SET=left_motor.pin=1,left_motor.name="a, b",right_motor.pin=2
        sensor: SCL_SET=controller.gain=1,controller.mode=auto
        x: SCL_SET=controller.gain=1,controller.mode=auto,left_motor.pin=1,left_motor.name="a, b",right_motor.pin=2
    "#]]
    .assert_eq(&variables(&values, &programs()));
}

#[test]
fn options_win_over_the_variable_and_the_variable_over_the_launch_file() {
    let known = rover();
    let given = options(&["controller.gain=3", "controller.gain=4", "controller.offsets=[1, 2, 3]"]);
    let inherited = Some("controller.gain=2, controller.mode=manual,left_motor.name=\"l,\"");
    let values = Values::new(&given, inherited, &launched(), Some(&known)).unwrap();
    expect![[r#"
        controller: SCL_SET=controller.gain=4,controller.offsets=[1, 2, 3],controller.mode=manual
        left_motor: SCL_SET=left_motor.pin=1,left_motor.name="l,",right_motor.pin=2
        right_motor: SCL_SET=left_motor.pin=1,left_motor.name="l,",right_motor.pin=2
        sensor: SCL_SET=controller.gain=4,controller.offsets=[1, 2, 3],controller.mode=manual
        x: SCL_SET=controller.gain=4,controller.offsets=[1, 2, 3],controller.mode=manual,left_motor.pin=1,left_motor.name="l,",right_motor.pin=2
    "#]].assert_eq(&variables(&values, &programs()));
}

#[test]
fn an_inherited_variable_is_cleared_for_programs_without_values() {
    let known = rover();
    let of = |inherited| {
        let values = Values::new(&options(&[]), inherited, &[], Some(&known)).unwrap();
        variables(&values, &[("sensor", Opens::Own)])
    };
    assert_eq!(of(Some("controller.gain=2")), "sensor: SCL_SET=\n");
    assert_eq!(of(Some("")), "sensor: no variable\n");
    assert_eq!(of(None), "sensor: no variable\n");
}

#[test]
fn without_a_topology_only_components_are_checked() {
    let components = launched();
    let values = Values::new(&options(&["sensor.rate=5 Hz"]), None, &components, None).unwrap();
    expect![[r#"
        controller: SCL_SET=controller.mode=auto,controller.gain=1
        left_motor: SCL_SET=left_motor.name="a, b",left_motor.pin=1
        right_motor: SCL_SET=right_motor.pin=2
        sensor: SCL_SET=controller.mode=auto,controller.gain=1,sensor.rate=5 Hz
        x: SCL_SET=right_motor.pin=2,left_motor.name="a, b",left_motor.pin=1,controller.mode=auto,controller.gain=1,sensor.rate=5 Hz
    "#]].assert_eq(&variables(&values, &programs()));
    let problems = Values::new(&options(&["senor.rate=5"]), None, &components, None).unwrap_err();
    expect![[r#"
        error: unknown component `senor` in `--set`
          = help: did you mean `sensor`?
          = note: the launch file has the components `right_motor`, `left_motor`, `controller`, `sensor`
    "#]]
    .assert_eq(&told(&problems));
}

#[test]
fn values_that_no_parameter_can_have_are_told_with_their_origin() {
    let known = rover();
    let given = options(&[
        "controler.gain=2",
        "motor.pin=2",
        "controller.gian=2",
        "sensor.rate=2",
        "controller.gain=fast",
        "controller.gain=20",
        "controller.mode=atuo",
    ]);
    let inherited = Some("contoller.gain=2,controller.gain=,left_motor.pni=3");
    let problems = Values::new(&given, inherited, &[], Some(&known)).unwrap_err();
    expect![[r#"
        error: unknown component `contoller` in `SCL_SET`
          = help: did you mean `controller`?
          = note: the topology has the components `sensor`, `controller`, `left_motor`, `right_motor`
          = note: `SCL_SET` is in the environment of `scl`
        error: wrong value of `controller.gain` in `SCL_SET`: expected a finite number, found ``
          = note: `SCL_SET` is in the environment of `scl`
        error: unknown parameter `left_motor.pni` in `SCL_SET`
          = help: did you mean `pin`?
          = note: component `left_motor` has the parameters `pin`, `name`
          = note: `SCL_SET` is in the environment of `scl`
        error: unknown component `controler` in `--set`
          = help: did you mean `controller`?
          = note: the topology has the components `sensor`, `controller`, `left_motor`, `right_motor`
        error: unknown component `motor` in `--set`
          = help: it is a kind: name one of its components, `left_motor`, `right_motor`
          = note: the topology has the components `sensor`, `controller`, `left_motor`, `right_motor`
        error: unknown parameter `controller.gian` in `--set`
          = help: did you mean `gain`?
          = note: component `controller` has the parameters `period`, `gain`, `offsets`, `mode`, `debug`, `count`
        error: unknown parameter `sensor.rate` in `--set`
          = note: component `sensor` has no parameters
        error: wrong value of `controller.gain` in `--set`: expected a finite number, found `fast`
        error: wrong value of `controller.gain` in `--set`: `20` is not from 0 to 10
        error: wrong value of `controller.mode` in `--set`: expected `manual` or `auto`, found `atuo`
          = help: did you mean `auto`?
    "#]]
    .assert_eq(&told(&problems));
    let problems = Values::new(&options(&[]), Some("controller.gain"), &[], Some(&known)).unwrap_err();
    expect![[r#"
        error: cannot read `SCL_SET`: expected `component.parameter=value`, found `controller.gain`
          = note: `SCL_SET` is in the environment of `scl`
    "#]]
    .assert_eq(&told(&problems));
}

/// Plans the run of a folder with this launch file, or with none.
fn plan(launch: Option<&str>, set: &[&str], change: impl FnOnce(&mut Options)) -> Result<RunPlan, Vec<Problem>> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("topology.yaml"), "").unwrap();
    std::fs::write(folder.path().join("Cargo.toml"), "").unwrap();
    if let Some(launch) = launch {
        std::fs::write(folder.path().join("launch.yaml"), launch).unwrap();
    }
    let mut options = Options { folder: folder.path().to_owned(), ..options(set) };
    change(&mut options);
    let shown = |problem: Problem| {
        Problem::rendered(problem.to_string().replace(&folder.path().display().to_string(), "FOLDER").trim_end())
    };
    let names = |_: &Path| -> Option<SystemNames> { Some(rover()) };
    plan_run(&options, &names).map_err(|problems| problems.into_iter().map(shown).collect())
}

/// The values that the programs of a plan get, or why there is none.
fn planned(plan: Result<RunPlan, Vec<Problem>>) -> String {
    let plan = match plan {
        Ok(plan) => plan,
        Err(problems) => return told(&problems),
    };
    let value = |environment: &[(String, String)]| {
        let values: Vec<&str> =
            environment.iter().filter(|(name, _)| name == scl_plan::SET_VARIABLE).map(|(_, value)| &**value).collect();
        values.join(" and ")
    };
    let one = |component: &crate::Component| format!("{}: {}\n", component.name, value(&component.program.environment));
    plan.components.iter().map(one).collect()
}

const LAUNCH: &str = "\
components:
  motor: {command: /bin/cat}
  left_motor: {parameters: {pin: 1}}
  controller: {command: /bin/cat, parameters: {gain: 2}}
profiles:
  replayed:
    motor: {replay: launch.yaml}
    left_motor: {command: /bin/cat}
";

#[test]
fn a_program_is_not_started_without_a_value_that_it_needs() {
    let with = |set: &[&str], change: fn(&mut Options)| planned(plan(Some(LAUNCH), set, change));
    expect![[r#"
        error: parameter `right_motor.pin` (u8) has no value
         --> FOLDER/launch.yaml:2:3
          = help: add `parameters: {pin: ...}` to its entry, or give `--set right_motor.pin=...`
    "#]]
    .assert_eq(&with(&[], |_| ()));
    let given = with(&["right_motor.pin=2"], |_| ());
    expect![[r#"
        left_motor: left_motor.pin=1,right_motor.pin=2
        right_motor: left_motor.pin=1,right_motor.pin=2
        controller: controller.gain=2
    "#]]
    .assert_eq(&given);
    let replayed = with(&[], |options| options.profiles = vec!["replayed".to_owned()]);
    expect![[r#"
        left_motor: left_motor.pin=1
        right_motor: 
        controller: controller.gain=2
    "#]]
    .assert_eq(&replayed);
    let without = with(&[], |options| options.without = vec!["right_motor".to_owned()]);
    expect![[r#"
        left_motor: left_motor.pin=1
        controller: controller.gain=2
    "#]]
    .assert_eq(&without);
}

#[test]
fn programs_of_a_package_get_values_and_need_them_too() {
    let with = |set: &[&str]| planned(plan(None, set, |_| ()));
    expect![[r#"
        error: parameter `left_motor.pin` (u8) has no value
          = help: give `--set left_motor.pin=...`, or write a launch file with `parameters: {pin: ...}`
        error: parameter `right_motor.pin` (u8) has no value
          = help: give `--set right_motor.pin=...`, or write a launch file with `parameters: {pin: ...}`
    "#]]
    .assert_eq(&with(&["controller.gain=2"]));
    expect![[r#"
        sensor: 
        controller: controller.gain=2
        left_motor: left_motor.pin=1,right_motor.pin=2
        right_motor: left_motor.pin=1,right_motor.pin=2
    "#]]
    .assert_eq(&with(&["controller.gain=2", "left_motor.pin=1", "right_motor.pin=2"]));
}
