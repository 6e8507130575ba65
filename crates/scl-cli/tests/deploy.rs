//! `scl deploy systemd`: what it writes, as systemd itself reads it.

use crate::system::System;
use expect_test::expect;
use scl_needs::needs;
use std::process::{Command, Output};

const TOPOLOGY: &str = "\
system: rover
kinds:
  - name: wheel
    gates: [turns: {pub: , unconnected: ok}]
components:
  - name: sensor
    gates: [fix: pub]
  - name: display
    gates: [fix: sub]
  - {name: left_wheel, kind: wheel}
  - {name: right_wheel, kind: wheel}
connections: [[sensor.fix, display.fix]]
";

const LAUNCH: &str = "\
components:
  sensor:
    command: [./sensor, --rate, '100 %', '$HOME']
    environment: {GREETING: 'say \"hi\" for 5%'}
    restart: on_failure
    ready_within: 5s
    alive_within: 500ms
    cpu: [0]
    priority: fifo:80
  display: {command: 'cat > \"$HOME/log\"', restart: always, essential: false, working_directory: with space}
  wheel: {command: ./sensor}
hosts:
  board: {address: 127.0.0.1, components: [sensor, display, left_wheel, right_wheel]}
  ground: {address: 127.0.0.2, components: []}
gateway: {port: 7447}
";

/// A folder with the programs of the launch file, and a gateway in the search path.
fn system(launch: &str) -> System {
    let script = "#!/bin/sh\n";
    let files = [("topology.yaml", TOPOLOGY), ("launch.yaml", launch), ("sensor", script), ("bin/scl-gateway", script)];
    let system = System::of_files(&files);
    system.write("with space/file", "");
    for name in ["sensor", "bin/scl-gateway"] {
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        std::fs::set_permissions(system.path(name), mode).unwrap();
    }
    system
}

fn deploy(system: &System, arguments: &[&str]) -> Output {
    let path = std::env::var_os("PATH").unwrap();
    let folders = [system.path("bin")].into_iter().chain(std::env::split_paths(&path));
    let mut command = system.scl(&[&["deploy", "systemd"], arguments].concat());
    command.env("PATH", std::env::join_paths(folders).unwrap()).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[needs("systemd-analyze")]
#[test]
fn systemd_accepts_the_units_without_a_word() {
    let system = system(&LAUNCH.replace("  ground: {address: 127.0.0.2, components: []}\n", ""));
    let output = deploy(&system, &["--host", "board", "--user", "root"]);
    let expected = ["gateway", "sensor", "display", "wheel@"].map(|name| format!("systemd/rover-{name}.service\n"));
    let expected = [expected.concat(), "systemd/rover.target\n".to_owned()].concat();
    assert_eq!((text(&output.stdout), text(&output.stderr)), (expected.clone(), String::new()));
    let units = expected.lines().map(|name| system.path(name));
    let verified = Command::new("systemd-analyze").args(["verify", "--man=no"]).args(units).output();
    let verified = verified.expect("systemd-analyze is missing; install the package `systemd`");
    assert_eq!((text(&verified.stderr).as_str(), verified.status.code()), ("", Some(0)));
}

#[test]
fn components_are_stopped_before_the_gateway() {
    let system = system(&LAUNCH.replace("  ground: {address: 127.0.0.2, components: []}\n", ""));
    deploy(&system, &["--host", "board", "-o", "units"]);
    let unit = |name: &str| std::fs::read_to_string(system.path(&format!("units/rover-{name}.service"))).unwrap();
    assert!(unit("sensor").contains("\nAfter=rover-gateway.service\n"));
    let gateway = unit("gateway");
    let folder = system.path("").canonicalize().unwrap();
    let folder = folder.display();
    let arguments = format!(" run --topology {folder}/topology.yaml --launch {folder}/launch.yaml --host board\n");
    assert!(gateway.contains(&arguments), "{gateway}");
    assert!(gateway.contains("\nRestart=always\n") && gateway.contains("\nType=notify\n"), "{gateway}");
}

#[test]
fn without_a_host_there_is_no_gateway() {
    let system = system(&LAUNCH.replace("  ground: {address: 127.0.0.2, components: []}\n", ""));
    let output = deploy(&system, &["--output", "units"]);
    let expected = ["rover-sensor.service", "rover-display.service", "rover-wheel@.service", "rover.target"];
    assert_eq!(text(&output.stdout), expected.map(|name| format!("units/{name}\n")).concat());
    let sensor = std::fs::read_to_string(system.path("units/rover-sensor.service")).unwrap();
    assert!(!sensor.contains("gateway") && !sensor.contains("User="), "{sensor}");
}

#[test]
fn mistakes_are_reported_and_nothing_is_written() {
    let system = system(LAUNCH);
    let output = deploy(&system, &["--host", "bord"]);
    expect![[r#"
        error: [SCL1202] host `ground` has no list of `components`
          --> ./launch.yaml:14:44
           |
        14 |   ground: {address: 127.0.0.2, components: []}
           |                                            ^^
           |
           = help: it lists the components that run there

    "#]]
    .assert_eq(&text(&output.stderr));
    assert_eq!(output.status.code(), Some(2));
    assert!(!system.path("systemd").exists());
    let empty = System::of_files(&[("topology.yaml", TOPOLOGY)]);
    let output = empty.scl(&["deploy", "systemd"]).output().unwrap();
    let folder = empty.path("").canonicalize().unwrap();
    expect![[r#"
        error: there is no `launch.yaml` in `FOLDER`
          = help: give the folder of a system, or a launch file; `scl run --help` shows one

    "#]]
    .assert_eq(&text(&output.stderr).replace(&*folder.to_string_lossy(), "FOLDER"));
    assert_eq!(output.status.code(), Some(2));
}
