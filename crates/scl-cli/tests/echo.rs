//! `scl echo` on running processes.

mod mistakes;

use crate::rover::Rover;
use crate::system::{ChildGuard, SpawnGuarded, kill};
use expect_test::{Expect, expect};
use serde_json::Value;
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{ChildStdout, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// Starts `scl`, whose lines are read one by one.
fn start(rover: &Rover, arguments: &[&str]) -> (ChildGuard, BufReader<ChildStdout>) {
    let mut command = rover.scl(arguments);
    let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn_guarded();
    let lines = BufReader::new(process.stdout.take().unwrap());
    (process, lines)
}

fn next_json(lines: &mut impl BufRead) -> Value {
    let mut line = String::new();
    lines.read_line(&mut line).unwrap();
    serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: `{line}`"))
}

fn standard_error(process: &mut ChildGuard) -> String {
    let mut text = String::new();
    process.stderr.take().unwrap().read_to_string(&mut text).unwrap();
    text
}

/// A text with all numbers made equal.
fn without_numbers(text: &str) -> String {
    let mut equal = String::new();
    for c in text.chars() {
        match c {
            '0'..='9' if equal.ends_with('N') => {}
            '0'..='9' => equal.push('N'),
            c => equal.push(c),
        }
    }
    equal.replace("N.N", "N")
}

#[track_caller]
fn check_text(rover: &Rover, arguments: &[&str], expected: Expect) {
    expected.assert_eq(&without_numbers(&rover.text(&[&["echo"], arguments].concat())));
}

#[test]
fn messages_are_shown_in_all_formats() {
    let rover = Rover::start();
    check_text(
        &rover,
        &["sensor.measurements", "-n", "2"],
        expect![[r#"
        ---
        speed: N
        count: N
        ---
        speed: N
        count: N
    "#]],
    );
    check_text(
        &rover,
        &["sensor.measurements", "--once", "--format", "json"],
        expect![[r#"
        {"gate":"sensor.measurements","time":"N-N-NTN:N:NZ","sequence":N,"kind":"message","message":{"speed":N,"count":N}}
    "#]],
    );
    check_text(
        &rover,
        &["sensor.measurements", "-n", "2", "--format", "csv"],
        expect![[r#"
        @time,@sequence,speed,count
        N,N,N,N
        N,N,N,N
    "#]],
    );
    check_text(
        &rover,
        &["sensor.measurements", "-n", "2", "--field", "speed"],
        expect![[r#"
        N
        N
    "#]],
    );
    check_text(
        &rover,
        &["sensor.measurements", "-n1", "--field", "count", "--field", "speed"],
        expect![[r#"
        ---
        count: N
        speed: N
    "#]],
    );
    check_text(
        &rover,
        &["sensor.position", "--once"],
        expect![[r#"
        ---
        latitude: N
        longitude: -N
        fix: "Nd \e[Nm"
    "#]],
    );
    check_text(
        &rover,
        &["sensor.position", "--once", "--format", "csv", "--field", "latitude"],
        expect![[r#"
        @time,@sequence,latitude
        N,N,N
    "#]],
    );
    let image = rover.json(&["echo", "sensor.image", "--once", "--format", "json"]);
    assert_eq!(image["message"]["length"], 1024);
    assert_eq!(image["message"]["why"], "the gate carries bytes of no declared type");
    // What it prints is what `scl pub` reads.
    let text = rover.text(&["echo", "sensor.measurements", "-n", "5"]);
    assert_eq!(text.matches("---\nspeed: ").count(), 5, "{text}");
}

#[test]
fn messages_of_a_gate_are_shown_one_after_another() {
    let rover = Rover::start();
    let arguments = ["echo", "sensor.measurements", "--format", "json", "-n", "10"];
    let text = rover.text(&arguments);
    let messages: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let first = messages[0]["sequence"].as_u64().unwrap();
    for (message, sequence) in messages.iter().zip(first..) {
        assert_eq!(message["gate"], "sensor.measurements");
        assert_eq!((message["kind"].as_str(), message["sequence"].as_u64()), (Some("message"), Some(sequence)));
        let count = message["message"]["count"].as_u64().unwrap();
        assert_eq!(message["message"]["speed"].as_f64(), Some(count as f64 / 10.0));
    }
    assert_eq!(messages.len(), 10);
}

#[test]
fn a_condition_selects_messages() {
    let rover = Rover::start();
    let condition = "count >= 20 and not (speed > 1e6 or count == 21)";
    let text = rover.text(&["echo", "sensor.measurements", "--where", condition, "-n", "3", "--format", "json"]);
    for line in text.lines() {
        let message: Value = serde_json::from_str(line).unwrap();
        let count = message["message"]["count"].as_u64().unwrap();
        assert!(count >= 20 && count != 21, "{line}");
    }
}

#[test]
fn requests_and_replies_have_the_number_of_their_call() {
    let rover = Rover::start();
    let text = rover.text(&["echo", "controller.commands", "-n", "6", "--format", "json"]);
    let messages: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let request = messages.iter().find(|message| message["kind"] == "request").unwrap();
    let reply = messages.iter().find(|it| it["kind"] == "reply" && it["call"] == request["call"]).unwrap();
    assert!(request["message"]["target_speed"].is_f64(), "{request}");
    assert_eq!(reply["message"], serde_json::json!({"accepted": true, "reason": "within limits"}));
    let text = rover.text(&["echo", "controller.commands", "-n", "2"]);
    assert!(text.contains("--- # controller.commands reply of call "), "{text}");
    let text = rover.text(&["echo", "controller.commands", "-n", "2", "--format", "csv"]);
    assert!(text.starts_with("@time,@sequence,@kind,@call,target_speed,accepted,reason\n"), "{text}");
}

#[test]
fn messages_of_several_gates_are_headed_by_their_gate() {
    let rover = Rover::start();
    let text = rover.text(&["echo", "sensor.measurements", "sensor.position", "-n", "20"]);
    assert!(text.contains("--- # sensor.measurements ") && text.contains("--- # sensor.position "), "{text}");
    // Messages that a gate receives are shown where they come from.
    let output =
        rover.scl(&["echo", "logger.events", "controller.sensor", "--once", "--format", "json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let note = String::from_utf8(output.stderr).unwrap();
    assert_eq!(note, "note: the messages of `controller.sensor` are observed at `sensor.measurements`\n");
}

#[test]
fn control_characters_of_messages_do_not_reach_the_terminal() {
    let rover = Rover::start();
    for format in ["yaml", "json"] {
        let text = rover.text(&["echo", "logger.events", "-n", "2", "--format", format]);
        assert!(text.contains("31mred") && !text.contains('\u{1b}'), "{text:?}");
    }
}

#[test]
fn a_payload_of_another_type_is_shown_with_the_reason() {
    // The fixture sends positions as JSON.
    let topology = "\
system: rover
schemas: [rover.proto]
components:
  - {name: sensor, gates: [position: {pub: rover.Position, codec: protobuf}]}
  - {name: controller, gates: [position: sub]}
connections:
  - [sensor.position, controller.position]
";
    let mut rover = Rover::of(topology);
    rover.play(&["sensor", "controller"], |_| {});
    let text = rover.text(&["echo", "sensor.position", "-n", "2", "--format", "json"]);
    for line in text.lines() {
        let message: Value = serde_json::from_str(line).unwrap();
        assert!(message["message"]["hex"].as_str().unwrap().starts_with("7b22"), "{line}");
        let why = message["message"]["why"].as_str().unwrap();
        assert!(why.contains("-byte payload is not a protobuf message `rover.Position`: at byte "), "{why}");
    }
    let text = rover.text(&["echo", "sensor.position", "-n", "2"]);
    assert_eq!(text.matches("hex: 7b22").count(), 2, "{text}");
}

#[test]
fn a_component_that_restarts_is_followed() {
    let mut rover = Rover::start();
    let (mut echo, mut lines) = start(&rover, &["echo", "sensor.measurements", "--format", "json"]);
    while next_json(&mut lines)["sequence"].as_u64() < Some(5) {}
    rover.kill("sensor");
    rover.play(&["sensor"], |_| {});
    let mut last = u64::MAX;
    let again = std::iter::from_fn(|| Some(next_json(&mut lines)["sequence"].as_u64().unwrap()));
    assert!(again.into_iter().take(100_000).any(|sequence| std::mem::replace(&mut last, sequence) > sequence));
    kill("-INT", echo.id());
    assert_eq!(echo.wait().unwrap().code(), Some(0));
    let expected = "note: `sensor.measurements` has disconnected; waiting until it runs again\n\
                    note: `sensor.measurements` is connected again\n";
    assert_eq!(standard_error(&mut echo), expected);
}

#[test]
fn messages_that_were_dropped_for_a_slow_reader_are_noted() {
    let mut rover = Rover::start();
    rover.stop("sensor");
    let (mut publisher, _output) = start(&rover, &["pub", "sensor.measurements", "-"]);
    let mut input = publisher.stdin.take().unwrap();
    input.write_all(b"{count: 1}\n").unwrap();
    wait_until_running(&rover, "sensor");
    let (mut echo, lines) = start(&rover, &["echo", "sensor.measurements", "--format", "json"]);
    let (sender, received) = channel();
    thread::spawn(move || lines.lines().try_for_each(|line| sender.send(line.unwrap())));
    // It connects after some of them.
    while received.recv_timeout(Duration::from_millis(10)).is_err() {
        input.write_all(b"{count: 2}\n").unwrap();
    }
    kill("-STOP", echo.id());
    // More than the gate and the sockets keep.
    input.write_all(&b"{count: 3}\n".repeat(60_000)).unwrap();
    kill("-CONT", echo.id());
    input.write_all(b"{count: 4}\n").unwrap();
    while !received.recv().unwrap().contains("\"count\":4") {}
    kill("-INT", echo.id());
    assert_eq!(echo.wait().unwrap().code(), Some(0));
    drop(input);
    assert!(publisher.wait().unwrap().success());
    let notes = standard_error(&mut echo);
    assert!(notes.contains(" messages of `sensor.measurements`: read too slowly\n"), "{notes}");
}

/// Waits until a process runs a component.
fn wait_until_running(rover: &Rover, component: &str) {
    rover.wait_for(&["list"], |list| {
        let mut components = list["components"].as_array().unwrap().iter();
        components.any(|it| it["name"] == component && it["state"] == "running").then_some(())
    });
}

#[test]
fn a_closed_pipe_ends_it() {
    let rover = Rover::start();
    let (mut echo, mut lines) = start(&rover, &["echo", "sensor.measurements"]);
    lines.read_line(&mut String::new()).unwrap();
    drop(lines);
    assert_eq!(echo.wait().unwrap().code(), Some(0));
    assert_eq!(standard_error(&mut echo), "");
}

#[test]
fn silence_within_the_timeout_is_the_answer_no() {
    let rover = Rover::start();
    let error = rover.error(&["echo", "sensor.measurements", "--where", "speed < 0", "--timeout", "100ms"], 1);
    expect![[r#"
        error: no message that meets the condition at `sensor.measurements` within 100ms
          = help: `scl info GATE` shows peers and rates
    "#]]
    .assert_eq(&error);
    // A component that hangs sends nothing either.
    kill("-STOP", rover.process_id("sensor"));
    let error = rover.error(&["echo", "sensor.measurements", "sensor.position", "--timeout", "100ms"], 1);
    expect![[r#"
        error: no message at `sensor.measurements`, `sensor.position` within 100ms
          = help: `scl info GATE` shows peers and rates
    "#]]
    .assert_eq(&error);
}

#[test]
fn a_component_stands_for_its_gates() {
    let rover = Rover::start();
    let (mut echo, mut lines) = start(&rover, &["echo", "sensor", "--format", "json"]);
    let mut left = BTreeSet::from(["sensor.measurements", "sensor.position", "sensor.image"].map(str::to_owned));
    while !left.is_empty() {
        let gate = next_json(&mut lines)["gate"].as_str().unwrap().to_owned();
        assert!(gate.starts_with("sensor."), "{gate}");
        left.remove(&gate);
    }
    kill("-INT", echo.id());
    assert_eq!(echo.wait().unwrap().code(), Some(0));
}

#[test]
fn what_starts_later_is_waited_for() {
    let mut rover = Rover::stopped();
    let arguments =
        ["echo", "sensor.measurements", "--system", "rover", "--where", "count >= 0", "--format", "csv", "-n", "1"];
    let (mut echo, mut lines) = start(&rover, &arguments);
    let mut notes = BufReader::new(echo.stderr.take().unwrap());
    let mut note = String::new();
    notes.read_line(&mut note).unwrap();
    assert_eq!(note, "note: `sensor.measurements` is not running; waiting until it starts\n");
    rover.play_alone("sensor");
    let mut header = String::new();
    lines.read_line(&mut header).unwrap();
    assert_eq!(header, "@time,@sequence,speed,count\n");
    assert_eq!(echo.wait().unwrap().code(), Some(0));
}
