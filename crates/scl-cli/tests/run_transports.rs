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
        error: `transport` is `ipc`, `tcp` or `shm`, not `shn`
         --> launch.yaml:2:1
          = help: did you mean `transport: shm`?

        error: unknown gate `camera.frame`
         --> launch.yaml:4:3
          = help: did you mean `camera.frames`?
          = note: component `camera` has the gates `camera.frames`

        error: unknown gate `camra.frames`
         --> launch.yaml:5:3
          = help: did you mean `camera.frames`?
          = note: the topology has the components `camera`, `viewer`

        error: unknown gate `viewer.x`
         --> launch.yaml:6:3
          = note: component `viewer` has the gates `viewer.frames`

        error: a gate is named like `camera.frames`, not `frames`
         --> launch.yaml:7:3

        error: the transport of `viewer.frames` is `ipc`, `tcp` or `shm`, not a list
         --> launch.yaml:8:3

        error: the transport of `camera.frames` is `ipc`, `tcp` or `shm`, not `smh`
         --> launch.yaml:9:3
          = help: did you mean `camera.frames: shm`?

        error: a gate is named like `camera.frames`, not `1`
         --> launch.yaml:3:1

    "#]]
    .assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(2));
    let system = System::of_files(&[("launch.yaml", &launch("transports: shm"))]);
    let output = system.run(&["launch.yaml"]);
    expect![[r#"
        error: `transports` is a mapping from gates like `camera.frames` to transports, not `shm`
         --> launch.yaml:2:1

    "#]]
    .assert_eq(&String::from_utf8(output.stderr).unwrap());
}
