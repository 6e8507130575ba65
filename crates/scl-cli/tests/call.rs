//! `scl call` with running processes, and with components that the test itself opens.

use crate::publish::{elsewhere, open};
use crate::rover::Rover;
use crate::system::SpawnGuarded;
use expect_test::{Expect, expect};
use std::process::Stdio;

#[test]
fn a_request_is_answered() {
    let mut rover = Rover::start();
    rover.stop("user_interface");
    let text = rover.text(&["call", "controller.commands", "{target_speed: 0.5}"]);
    assert_eq!(text, "accepted: true\nreason: within limits\n");
    let json = rover.json(&["call", "controller.commands", "{}", "--as", "user_interface", "--format", "json"]);
    assert_eq!(json, serde_json::json!({"accepted": true, "reason": "within limits"}));
    let output = elsewhere(&rover, &["call", "controller.commands", "{target_speed: 0.5}"]).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "accepted: true\nreason: within limits\n");
}

#[test]
fn the_request_is_what_was_written() {
    let rover = Rover::stopped();
    let mut controller = open(&rover, "controller");
    let mut commands = controller.replier("commands").unwrap();
    let arguments = ["call", "controller.commands", "{target_speed: -1.5}", "--timeout", "60s"];
    let process = rover.scl(&arguments).stdout(Stdio::piped()).spawn_guarded();
    let request = commands.recv_blocking().unwrap();
    assert_eq!(request.message()[..], [&[9][..], &(-1.5_f64).to_le_bytes()].concat());
    // A reply that cannot be decoded is shown.
    request.reply(&"\u{1}".into()).unwrap();
    let output = process.wait_with_output();
    assert_eq!(output.status.code(), Some(0));
    expect![[r#"
        length: 1
        hex: '01'
        why: 'this 1-byte payload is not a protobuf message `rover.Status`: at byte 0: expected the start of a field'
    "#]]
    .assert_eq(&String::from_utf8(output.stdout).unwrap());
}

#[test]
fn a_template_needs_no_running_system() {
    let rover = Rover::stopped();
    let template = rover.text(&["call", "controller.commands", "--template"]);
    assert_eq!(template, "target_speed: 0.0\n");
    assert_eq!(rover.json(&["call", "controller.commands", "--template", "--format", "json"])["target_speed"], 0.0);
    let rover = Rover::start();
    let output = elsewhere(&rover, &["call", "controller.commands", "--template"]).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), template);
}

/// Not even to a component that runs: defaults may move an actuator.
#[test]
fn without_a_request_nothing_is_sent() {
    let rover = Rover::stopped();
    let mut controller = open(&rover, "controller");
    let mut commands = controller.replier("commands").unwrap();
    for arguments in [&["call", "controller.commands"][..], &["call", "controller.commands", ""]] {
        let output = rover.scl(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(String::from_utf8_lossy(&output.stderr).starts_with("error: "), "{arguments:?}");
    }
    let output = rover.scl(&["call", "controller.commands"]).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), "target_speed: 0.0\n");
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "error: there is no request, so nothing was sent; an example is on standard output\n  \
           = help: `scl call controller.commands '{}'` sends one with defaults\n"
    );
    // The first request that arrives is the one that was written.
    let arguments = ["call", "controller.commands", "{target_speed: 2}", "--timeout", "60s"];
    let process = rover.scl(&arguments).stdout(Stdio::null()).spawn_guarded();
    let request = commands.recv_blocking().unwrap();
    assert_eq!(request.message()[..], [&[9][..], &2_f64.to_le_bytes()].concat());
    request.reply(&"".into()).unwrap();
    assert!(process.wait_with_output().status.success());
}

#[test]
fn a_replier_that_does_not_reply_is_the_answer_no() {
    let rover = Rover::stopped();
    let error = rover.error(&["call", "controller.commands", "{}", "--timeout", "100ms"], 2);
    assert!(error.starts_with("error: gate `user_interface.commands` got no reply from `controller.commands` within "));
    assert!(error.ends_with(": `controller.commands` is not running\n"), "{error}");
    let _controller = open(&rover, "controller");
    let error = rover.error(&["call", "controller.commands", "{}", "--timeout", "5s"], 1);
    assert!(error.starts_with("error: gate `user_interface.commands` got no reply from `controller.commands` within "));
}

#[test]
fn every_requester_runs() {
    let rover = Rover::start();
    let error = rover.error(&["call", "controller.commands", "{}"], 2);
    let expected = format!(
        "error: every requester of `controller.commands` is running\n  \
           = help: stop one of them; `scl call` then stands in for it\n  \
           = note: `user_interface` is process {}\n",
        rover.process_id("user_interface")
    );
    assert_eq!(error, expected);
    let error = rover.error(&["call", "controller.commands", "{}", "--as", "user_interface"], 2);
    assert!(error.contains(&format!("already running as process {}", rover.process_id("user_interface"))), "{error}");
}

#[test]
fn several_requesters_are_a_question() {
    let topology = "\
system: rover
schemas: [rover.proto]
components:
  - {name: controller, gates: [commands: {rep: rover.Command -> rover.Status}, raw: rep]}
  - {name: screen, gates: [commands: {req: rover.Command -> rover.Status}, raw: req]}
  - {name: remote, gates: [commands: {req: rover.Command -> rover.Status}]}
connections:
  - [controller.commands, screen.commands]
  - [controller.commands, remote.commands]
  - [controller.raw, screen.raw]
";
    let rover = Rover::of(topology);
    expect![[r#"
        error: several requesters of `controller.commands` are not running
          = help: choose one with `--as screen`
          = note: not running: `screen`, `remote`
    "#]]
    .assert_eq(&rover.error(&["call", "controller.commands", "{}"], 2));
    expect![[r#"
        error: cannot make an example request for `controller.raw`
          = note: its type `bytes`, in `raw`, has no schema
    "#]]
    .assert_eq(&rover.error(&["call", "controller.raw", "--template"], 2));
}

#[test]
fn mistakes_say_what_to_write() {
    let rover = Rover::stopped();
    let check = |arguments: &[&str], expected: Expect| {
        expected.assert_eq(&rover.error(&[&["call"], arguments].concat(), 2));
    };
    check(
        &["controller.commands", "{target: 0.5}"],
        expect![[r#"
            error: message `rover.Command` has no field `target`
              = help: did you mean `target_speed`?
              = note: its fields: `target_speed`
        "#]],
    );
    check(
        &["controller.commands", "{}", "--as", "sensor"],
        expect![[r#"
        error: component `sensor` is not a requester of `controller.commands`
          = note: its requesters: `user_interface`
    "#]],
    );
    check(
        &["controller.command"],
        expect![[r#"
        error: component `controller` has no gate `command`
          = help: did you mean `controller.commands`?
          = note: its gates: `controller.sensor`, `controller.position`, `controller.actuator`, `controller.commands`, `controller.log`
    "#]],
    );
    check(
        &["user_interface.commands"],
        expect![[r#"
        error: `user_interface.commands` is a `req` gate, which takes no requests
          = help: call the gate that answers: `scl call controller.commands REQUEST --as user_interface`
    "#]],
    );
    check(
        &["sensor.measurements"],
        expect![[r#"
        error: `sensor.measurements` is a `pub` gate, which takes no requests
          = help: `scl pub sensor.measurements MESSAGE` sends messages there
    "#]],
    );
}
