//! The transports of a launch file: what programs get, and mistakes.

use crate::system::System;
use expect_test::expect;

const TOPOLOGY: &str = "\
components:
  - name: camera
    gates: [{frames: pub}]
  - name: viewer
    gates: [{frames: sub}]
connections: [[camera.frames, viewer.frames]]
";

fn launch(transports: &str) -> String {
    let command = "echo ${SCL_TRANSPORT-unset}";
    format!("components: {{camera: {{command: '{command}'}}, viewer: {{command: ':'}}}}\n{transports}\n")
}

#[test]
fn programs_get_the_transports_in_one_variable() {
    let cases = [
        ("", None, "unset"),
        ("transport: shm", None, "shm"),
        ("transport: ipc\ntransports: {camera.frames: shm}", Some("tcp"), "ipc,camera.frames=shm"),
        ("transports: {viewer.frames: shm}", Some("tcp"), "tcp,viewer.frames=shm"),
        ("transport: shm\nenvironment: {SCL_TRANSPORT: tcp}", None, "tcp"),
    ];
    for (transports, inherited, expected) in cases {
        let system = System::of_files(&[("launch.yaml", &launch(transports)), ("topology.yaml", TOPOLOGY)]);
        let mut command = system.scl(&["run"]);
        command.env_remove("SCL_TRANSPORT").envs(inherited.map(|value| ("SCL_TRANSPORT", value)));
        let output = command.output().unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), format!("camera | {expected}\n"), "{transports}");
    }
}

#[test]
fn mistakes_have_their_place_and_the_nearest_name() {
    let wrong = "\
transport: shn
transports:
  camera.frame: shm
  camra.frames: shm
  viewer.x: shm
  frames: ipc
  viewer.frames: [shm]
  camera.frames: smh
  1: ipc";
    let system = System::of_files(&[("launch.yaml", &launch(wrong)), ("topology.yaml", TOPOLOGY)]);
    let output = system.run(&["launch.yaml"]);
    expect![[r#"
        error: [SCL1202] `transport` is `ipc`, `tcp` or `shm`, not `shn`
         --> launch.yaml:2:12
          |
        2 | transport: shn
          |            ^^^
          |
          = help: did you mean `transport: shm`?

        error: [SCL1205] unknown gate `camera.frame`
         --> launch.yaml:4:3
          |
        4 |   camera.frame: shm
          |   ^^^^^^^^^^^^
          |
          = note: component `camera` has the gates `camera.frames`

        error: [SCL1205] unknown gate `camra.frames`
         --> launch.yaml:5:3
          |
        5 |   camra.frames: shm
          |   ^^^^^^^^^^^^
          |
          = note: the topology has the components `camera`, `viewer`

        error: [SCL1205] unknown gate `viewer.x`
         --> launch.yaml:6:3
          |
        6 |   viewer.x: shm
          |   ^^^^^^^^
          |
          = note: component `viewer` has the gates `viewer.frames`

        error: [SCL1207] a gate is named `component.gate`, not `frames`
         --> launch.yaml:7:3
          |
        7 |   frames: ipc
          |   ^^^^^^

        error: [SCL1202] the transport of `viewer.frames` is `ipc`, `tcp` or `shm`, not a list
         --> launch.yaml:8:18
          |
        8 |   viewer.frames: [shm]
          |                  ^^^^^
          |
          = help: did you mean `viewer.frames: shm`?

        error: [SCL1202] the transport of `camera.frames` is `ipc`, `tcp` or `shm`, not `smh`
         --> launch.yaml:9:18
          |
        9 |   camera.frames: smh
          |                  ^^^
          |
          = help: did you mean `camera.frames: shm`?

        error: [SCL1207] a gate is named `component.gate`, not `1`
          --> launch.yaml:10:3
           |
        10 |   1: ipc
           |   ^

    "#]]
    .assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(2));
    let system = System::of_files(&[("launch.yaml", &launch("transports: shm"))]);
    let output = system.run(&["launch.yaml"]);
    expect![[r#"
        error: [SCL1203] `transports` is a mapping, not `shm`
         --> launch.yaml:2:13
          |
        2 | transports: shm
          |             ^^^
          |
          = help: write `transport: shm`

    "#]]
    .assert_eq(&String::from_utf8(output.stderr).unwrap());
}
