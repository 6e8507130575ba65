//! `scl run --host`: the components of one host, and its gateway, which is a script here.

mod mistakes;

use crate::system::{Started, System, kill};
use expect_test::{Expect, expect};
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::process::{Command, Output};

const TOPOLOGY: &str = "\
system: rover
components:
  - name: sensor
    gates: [fix: pub]
  - name: display
    gates: [fix: sub]
connections: [[sensor.fix, display.fix]]
";

/// Says which components run, and that they are ready; ends when told to.
const PROGRAM: &str = "\
#!/usr/bin/env python3
import os, signal, socket, sys
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
if sys.argv[1:2] == ['check']:
    if os.path.exists('refused'): sys.exit('error: the certificate has expired')
    sys.exit(0)
print(os.getpid(), *sys.argv[1:], flush=True)
socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto(b'READY=1', os.environ['NOTIFY_SOCKET'])
signal.sigwait([signal.SIGTERM])
";

const LAUNCH: &str = "\
components:
  sensor: {command: [./program, sensor]}
  display: {command: [./program, display]}
hosts:
  board: {address: 192.0.2.10, components: [sensor]}
  ground: {address: 192.0.2.20, components: [display]}
gateway: {port: 7447, certificates: keys}
";

/// A system with a `scl` of its own, so that no other gateway lies beside it.
struct Hosts {
    system: System,
    bin: tempfile::TempDir,
}

impl Hosts {
    fn new(with_gateway: bool) -> Self {
        let files = [("launch.yaml", LAUNCH), ("topology.yaml", TOPOLOGY), ("program", PROGRAM)];
        let system = System::of_files(&files);
        let mode = |path: PathBuf| std::fs::set_permissions(path, PermissionsExt::from_mode(0o755)).unwrap();
        mode(system.path("program"));
        // In the file system of the binary, which is linked to.
        let bin = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
        std::fs::hard_link(env!("CARGO_BIN_EXE_scl"), bin.path().join("scl")).unwrap();
        if with_gateway {
            let gateway = bin.path().join("scl-gateway");
            std::fs::write(&gateway, PROGRAM).unwrap();
            mode(gateway);
        }
        Self { system, bin }
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let plain = self.system.scl(&[]);
        let mut command = Command::new(self.bin.path().join("scl"));
        command.args(arguments).current_dir(self.system.path(""));
        command.envs(plain.get_envs().filter_map(|(name, value)| Some((name, value?))));
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    fn start(&self, arguments: &[&str]) -> Started {
        Started::spawn(&mut self.command(arguments))
    }

    /// What the gateway prints after its process id.
    fn gateway_arguments(&self) -> String {
        let folder = self.system.path("").canonicalize().unwrap();
        let folder = folder.display();
        format!("run --topology {folder}/topology.yaml --launch {folder}/launch.yaml --host board")
    }

    fn process_of(line: &str) -> u32 {
        line.split(' ').nth(2).and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{line}"))
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn the_components_of_the_host_and_its_gateway_are_started_and_the_gateway_is_stopped_last() {
    let hosts = Hosts::new(true);
    let mut run = hosts.start(&["run", "--host", "board"]);
    run.wait_for_error("all components are ready");
    run.signal("-TERM");
    let (status, out, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
    assert!(
        out.lines().any(|line| line.starts_with("gateway | ") && line.ends_with(&hosts.gateway_arguments())),
        "{out}"
    );
    assert!(out.contains(" sensor\n") && !out.contains("display"), "{out}");
    let ended =
        |name: &str| err.find(&format!("{name}  ended with exit code 0")).unwrap_or_else(|| panic!("{name}: {err}"));
    assert!(ended("sensor ") < ended("gateway"), "{err}");
}

#[test]
fn a_gateway_that_ends_is_started_again_and_the_components_go_on() {
    let hosts = Hosts::new(true);
    let mut run = hosts.start(&["run", "--host", "board"]);
    let (mut sensor, mut gateways) = (None, Vec::new());
    while gateways.len() < 3 {
        let line = run.next_line().unwrap();
        if line.starts_with("gateway") {
            gateways.push(Hosts::process_of(&line));
            if gateways.len() < 3 {
                kill("-KILL", *gateways.last().unwrap());
            }
        } else {
            assert_eq!(sensor.replace(line.clone()), None, "the sensor was started again");
        }
    }
    let restarted = hosts.run(&["restart", "gateway"]);
    assert!(restarted.status.success(), "{restarted:?}");
    run.wait_for("gateway | ");
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
    assert!(err.contains("scl: program `gateway` was restarted twice; last reason: killed by signal 9"), "{err}");
}

#[test]
fn a_gateway_that_cannot_run_is_known_before_anything_is_started() {
    let hosts = Hosts::new(true);
    hosts.system.write("refused", "");
    let output = hosts.run(&["run", "--host", "board"]);
    expect![[r#"
        error: the certificate has expired
        error: the gateway cannot run with these files
          = note: nothing was started

    "#]]
    .assert_eq(&text(&output.stderr));
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), String::new()));
}

#[test]
fn a_second_run_of_the_host_needs_no_second_gateway() {
    let hosts = Hosts::new(false);
    for choice in [["--only", "sensor"], ["--without", "gateway"]] {
        let mut run = hosts.start(&[&["run", "--host", "board"], &choice[..]].concat());
        run.wait_until("sensor", |line| line.starts_with("sensor | ") && line.ends_with(" sensor"));
        run.signal("-TERM");
        let (status, out, err) = run.finish();
        assert_eq!((status.code(), out.as_str()), (Some(0), ""), "{err}");
        assert!(!err.contains("gateway"), "{err}");
    }
}

#[test]
fn without_a_host_everything_runs_here_and_that_is_said() {
    let hosts = Hosts::new(false);
    let mut run = hosts.start(&["run"]);
    run.wait_for_error("note: without `--host`, the components of all hosts run on this machine, without gateways");
    run.wait_for_error("all components are ready");
    run.signal("-TERM");
    let (status, out, _) = run.finish();
    assert_eq!(status.code(), Some(0));
    assert!(out.contains(" sensor\n") && out.contains(" display\n"), "{out}");
}

#[test]
fn a_component_called_gateway_does_not_run_with_a_host() {
    let hosts = Hosts::new(true);
    for (file, text) in [("launch.yaml", LAUNCH), ("topology.yaml", TOPOLOGY)] {
        hosts.system.write(file, &text.replace("display", "gateway"));
    }
    let output = hosts.run(&["run", "--host", "ground"]);
    let err = text(&output.stderr);
    assert!(err.contains("with `hosts`, no component can be called `gateway`"), "{err}");
    assert_eq!(output.status.code(), Some(2), "{err}");
}

#[track_caller]
fn check(files: &[(&str, &str)], arguments: &[&str], expected: &Expect) {
    let hosts = Hosts::new(true);
    files.iter().for_each(|(name, text)| hosts.system.write(name, text));
    let output = hosts.run(arguments);
    let folder = hosts.system.path("").canonicalize().unwrap();
    expected.assert_eq(&text(&output.stderr).replace(&*folder.to_string_lossy(), "FOLDER"));
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), String::new()));
}

#[test]
fn a_missing_gateway_program_is_explained() {
    let hosts = Hosts::new(false);
    let output = hosts.command(&["run", "--host", "board"]).env("PATH", "/nowhere").output().unwrap();
    expect![[r#"
        error: the program `scl-gateway`, which connects the hosts, is not installed
          = help: install it: `cargo install scl-gateway`; in the repository of SCL: `cargo build -p scl-gateway`
          = note: it is looked for beside `scl`, then in PATH

    "#]]
    .assert_eq(&text(&output.stderr));
    let output = hosts.command(&["gateway", "run"]).env("PATH", "/nowhere").output().unwrap();
    expect![[r#"
        error: there is no command `gateway`
          = help: install it: `cargo install scl-gateway`; in the repository of SCL: `cargo build -p scl-gateway`
          = note: there is no program `scl-gateway` beside `scl` or in PATH either
    "#]]
    .assert_eq(&text(&output.stderr));
}

#[test]
fn unknown_hosts_get_a_suggestion() {
    check(
        &[],
        &["run", "--host", "bord"],
        &expect![[r#"
        error: unknown host `bord`
         --> ./launch.yaml
          = help: did you mean `board`?
          = note: the launch file has the hosts `board`, `ground`

    "#]],
    );
    check(
        &[("launch.yaml", "components: {sensor: {command: ls}}")],
        &["run", "--host", "board"],
        &expect![[r#"
        error: the launch file has no `hosts`
         --> ./launch.yaml
          = help: write `hosts: {board: {address: 192.0.2.10, components: [sensor]}}` and `gateway: {port: 7447}`

    "#]],
    );
    check(
        &[],
        &["run", "--host", "board", "--only", "display"],
        &expect![[r#"
            error: unknown component `display` in `--only`
              = note: host `board` has the components `sensor`, `gateway`

        "#]],
    );
}
