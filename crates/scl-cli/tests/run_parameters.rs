//! `scl run` and values of parameters: the launch file, `SCL_SET` and `--set`.

use crate::system::{System, without_times};
use expect_test::expect;

const LAUNCH: &str = "\
components:
  controller:
    command: echo \"${SCL_SET-unset}\"
    parameters: {gain: 1.5, offsets: [0, 0.1, 0]}
  sensor: {command: 'echo \"${SCL_SET-unset}\"'}
profiles:
  careful:
    controller: {parameters: {gain: 0.5}}
";

const TOPOLOGY: &str = "\
system: rover
kinds:
  - name: motor
    parameters:
      - pin: u8
      - mode: {one_of: [speed, torque], default: speed}
    gates: []
components:
  - name: controller
    parameters:
      - gain: {f64: 0.8, range: [0, 10]}
      - offsets: {list: f64, length: 3, default: [0, 0, 0]}
    gates: []
  - {name: sensor, gates: []}
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor}
connections: []
";

const MOTORS: &str = "  motor: {command: 'echo \"$SCL_SET\"', parameters: {mode: torque}}
  left_motor: {parameters: {pin: 3}}
";

/// What the programs print, or what `scl run` says if it starts nothing.
#[track_caller]
fn printed(arguments: &[&str], inherited: Option<&str>) -> String {
    printed_of(&[("launch.yaml", LAUNCH)], arguments, inherited)
}

/// As [`printed`], with these files.
#[track_caller]
fn printed_of(files: &[(&str, &str)], arguments: &[&str], inherited: Option<&str>) -> String {
    let system = System::of_files(files);
    let mut command = system.scl(&[&["run"], arguments].concat());
    command.envs(inherited.map(|value| ("SCL_SET", value)));
    let output = command.output().unwrap();
    let errors = without_times(&output.stderr);
    match output.status.code() {
        Some(0) => {
            let mut lines: Vec<String> = String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect();
            lines.sort_unstable();
            format!("{}\n", lines.join("\n"))
        }
        Some(2) => errors,
        other => panic!("{other:?} {errors}"),
    }
}

#[test]
fn programs_find_their_values_in_a_variable_and_the_last_one_counts() {
    expect![[r#"
        controller | controller.gain=1.5,controller.offsets=[0, 0.1, 0]
        sensor     | unset
    "#]]
    .assert_eq(&printed(&[], None));
    expect![[r#"
        controller | controller.gain=0.5,controller.offsets=[0, 0.1, 0]
        sensor     | unset
    "#]]
    .assert_eq(&printed(&["--profile", "careful"], None));
    let inherited = Some("controller.gain=2,controller.mode=auto");
    expect![[r#"
        controller | controller.gain=2,controller.offsets=[0, 0.1, 0],controller.mode=auto
        sensor     | 
    "#]]
    .assert_eq(&printed(&[], inherited));
    let set = ["--set", "controller.gain=3", "--set", "controller.offsets=[1, \"a, b\"]", "--set", "sensor.rate=5 Hz"];
    expect![[r#"
        controller | controller.gain=3,controller.offsets=[1, "a, b"],controller.mode=auto
        sensor     | sensor.rate=5 Hz
    "#]]
    .assert_eq(&printed(&set, inherited));
}

/// The program writes its values as a component does, and fails twice.
#[test]
fn live_values_are_kept_when_a_component_is_started_again() {
    const TOPOLOGY: &str = "\
system: rover
components:
  - name: controller
    parameters:
      - gain: {f64: 0.8, live: true}
      - names: {list: text, default: [], live: true}
      - pin: {u8: 1}
    gates: []
  - {name: other, parameters: [{gain: {f64: 1, live: true}}], gates: []}
";
    let program = r#"echo "${SCL_SET-unset}"
mkdir -p -m 700 "$SCL_RUNTIME_DIR/rover"
echo x >> starts
write() { printf '%s\n%s\n' "$1" "$1" > "$SCL_RUNTIME_DIR/rover/controller.values"; }
case $(wc -l < starts) in
1) write '{"gain": "2", "names": "[\"a, b\"]", "pin": "7"}'; exit 1;;
2) write '{"gain": "3", "names": "[]", "pin": "7"}'; exit 1;;
esac
"#;
    let launch = "components: {controller: {command: [sh, program.sh], restart: on_failure, restart_delay: 1ms, parameters: {gain: 1, pin: 4}}}";
    let system = System::of_files(&[("launch.yaml", launch), ("topology.yaml", TOPOLOGY), ("program.sh", program)]);
    // An earlier run has left values behind.
    let runtime_dir = system.path("runtime");
    std::fs::create_dir_all(runtime_dir.join("rover")).unwrap();
    set_private(&runtime_dir);
    set_private(&runtime_dir.join("rover"));
    let stale = "{\"gain\": \"9\"}\n".repeat(2);
    std::fs::write(runtime_dir.join("rover/controller.values"), stale).unwrap();
    let output = system.run(&[]);
    assert_eq!(output.status.code(), Some(0), "{}", without_times(&output.stderr));
    expect![[r#"
        controller | controller.gain=1,controller.pin=4
        controller | controller.pin=4,controller.gain=2,controller.names=["a, b"]
        controller | controller.pin=4,controller.gain=3,controller.names=[]
    "#]]
    .assert_eq(&String::from_utf8(output.stdout).unwrap());
}

#[test]
fn values_that_no_program_can_be_given_are_told_before_the_start() {
    let long = "x".repeat(60_000);
    let topology = "\
system: rover
components:
  - {name: controller, parameters: [{a: {text: \"\"}}, {b: {text: \"\"}}, {c: {text: \"\"}}], gates: []}
";
    let launch =
        format!("components: {{controller: {{command: echo, parameters: {{a: {long}, b: {long}, c: {long}}}}}}}");
    expect![[r#"
        error: the variable `SCL_SET` of component `controller` has 180050 bytes
          = help: it has the values of the parameters: put long ones into a file, and give its path
          = note: the operating system passes at most 131072 to a program

    "#]]
    .assert_eq(&printed_of(&[("launch.yaml", &launch), ("topology.yaml", topology)], &[], None));
    let launch = format!("components: {{controller: {{command: echo, environment: {{NAMES: {long}{long}{long}}}}}}}");
    expect![[r#"
        error: the variable `NAMES` of component `controller` has 180007 bytes
          = help: put the value into a file, and give its path
          = note: the operating system passes at most 131072 to a program

    "#]]
    .assert_eq(&printed_of(&[("launch.yaml", &launch)], &[], None));
}

fn set_private(folder: &std::path::Path) {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o700)).unwrap();
}

#[test]
fn mistakes_in_values_are_found_before_the_start() {
    expect![[r#"
        error: unknown component `controler` in `--set`
          = help: did you mean `controller`?
          = note: the launch file has the components `controller`, `sensor`

    "#]]
    .assert_eq(&printed(&["--set", "controler.gain=3"], None));
    expect![[r#"
        error: unknown component `senor` in `SCL_SET`
          = help: did you mean `sensor`?
          = note: the launch file has the components `controller`, `sensor`
          = note: `SCL_SET` is in the environment of `scl`

    "#]]
    .assert_eq(&printed(&[], Some("senor.rate=5")));
    expect![[r#"
        error: cannot read `SCL_SET`: expected `component.parameter=value`, found `sensor.rate`
          = note: `SCL_SET` is in the environment of `scl`

    "#]]
    .assert_eq(&printed(&[], Some("sensor.rate")));
    expect![[r#"
        error: invalid value 'sensor.rate' for '--set <COMPONENT.PARAMETER=VALUE>': expected `component.parameter=value`, found `sensor.rate`

        For more information, try '--help'.
    "#]].assert_eq(&printed(&["--set", "sensor.rate"], None));
}

#[test]
fn values_are_checked_against_the_topology() {
    let launch = LAUNCH.replace("profiles:\n", &format!("{MOTORS}profiles:\n"));
    let with = |launch: &str, arguments: &[&str], inherited| {
        printed_of(&[("launch.yaml", launch), ("topology.yaml", TOPOLOGY)], arguments, inherited)
    };
    expect![[r#"
        error: parameter `right_motor.pin` (u8) has no value
         --> ./launch.yaml:6:3
          = help: add `parameters: {pin: ...}` to its entry, or give `--set right_motor.pin=...`

    "#]]
    .assert_eq(&with(&launch, &[], None));
    expect![[r#"
        controller  | controller.gain=1.5,controller.offsets=[0, 0.1, 0]
        left_motor  | left_motor.pin=3,left_motor.mode=speed,right_motor.pin=4,right_motor.mode=torque
        right_motor | left_motor.pin=3,left_motor.mode=speed,right_motor.pin=4,right_motor.mode=torque
        sensor      | 
    "#]]
    .assert_eq(&with(&launch, &["--set", "right_motor.pin=4"], Some("left_motor.mode=speed")));
    expect![[r#"
        error: wrong value of `left_motor.mode` in `SCL_SET`: expected `speed` or `torque`, found `spede`
          = help: did you mean `speed`?
          = note: `SCL_SET` is in the environment of `scl`

        error: unknown parameter `right_motor.pni` in `--set`
          = help: did you mean `pin`?
          = note: component `right_motor` has the parameters `pin`, `mode`

    "#]]
    .assert_eq(&with(&launch, &["--set", "right_motor.pni=4"], Some("left_motor.mode=spede")));
    let wrong = launch.replace("gain: 1.5", "gian: 1.5").replace("pin: 3", "pin: 300").replace("torque", "torq");
    expect![[r#"
        error: [SCL1205] component `controller` has no parameter `gian`
         --> ./launch.yaml:4:18
          |
        4 |     parameters: {gian: 1.5, offsets: [0, 0.1, 0]}
          |                  ^^^^
          |
          = help: did you mean `gain`?
          = note: it has the parameters `gain`, `offsets`

        error: [SCL1202] parameter `motor.mode` cannot have this value
         --> ./launch.yaml:6:58
          |
        6 |   motor: {command: 'echo "$SCL_SET"', parameters: {mode: torq}}
          |                                                          ^^^^ expected `speed` or `torque`, found `torq`
          |
          = help: did you mean `mode: torque`?

        error: [SCL1202] parameter `left_motor.pin` cannot have this value
         --> ./launch.yaml:7:34
          |
        7 |   left_motor: {parameters: {pin: 300}}
          |                                  ^^^ expected a whole number from 0 to 255, found `300`

    "#]]
    .assert_eq(&with(&wrong, &["--set", "right_motor.pin=4"], None));
    let system = System::of_files(&[("launch.yaml", &launch), ("topology.yaml", TOPOLOGY)]);
    let checked = system.scl(&["check", "launch.yaml"]).output().unwrap();
    expect![[r#"
        warning: [SCL1211] parameter `right_motor.pin` (u8) has no value
         --> launch.yaml:6:3
          |
        6 |   motor: {command: 'echo "$SCL_SET"', parameters: {mode: torque}}
          |   ^^^^^
          |
          = help: add `parameters: {pin: ...}`
          = note: the topology declares it without a default

        launch.yaml: 1 warning
    "#]]
    .assert_eq(&String::from_utf8(checked.stderr).unwrap());
    assert_eq!(checked.status.code(), Some(0));
}
