//! `scl pub` with running processes, and with components that the test itself opens.

use crate::rover::Rover;
use crate::system::SpawnGuarded;
use expect_test::expect;
use scl::OpenOptions;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Opens a component of a system in this process.
pub(crate) fn open(rover: &Rover, component: &str) -> Component {
    let plans = SystemPlan::from_json(&std::fs::read_to_string(rover.path("plan.json")).unwrap()).unwrap();
    let options = OpenOptions::new().runtime_dir(rover.runtime_dir());
    Component::open_blocking_with(plans.component(component).unwrap(), options).unwrap()
}

/// `scl` in a folder without a topology file.
pub(crate) fn elsewhere(rover: &Rover, arguments: &[&str]) -> Command {
    rover.write("elsewhere/.keep", "");
    let mut command = rover.scl(arguments);
    command.current_dir(rover.path("elsewhere"));
    command
}

const LONG: Duration = Duration::from_secs(300);

/// An event, as protobuf.
fn event(text: &str) -> Vec<u8> {
    [&[10, u8::try_from(text.len()).unwrap()], text.as_bytes()].concat()
}

#[test]
fn a_message_reaches_the_peer_before_the_command_ends() {
    let rover = Rover::stopped();
    let (mut logger, mut controller) = (open(&rover, "logger"), open(&rover, "controller"));
    let (mut events, mut sensor) = (logger.puller("events").unwrap(), controller.subscriber("sensor").unwrap());
    assert_eq!(rover.text(&["pub", "sensor.log", "{text: hello}"]), "");
    assert_eq!(events.recv_timeout(LONG).unwrap(), event("hello"));
    assert_eq!(rover.text(&["pub", "sensor.measurements", r#"{"speed": 1.5}"#, "--topology", "topology.yaml"]), "");
    assert_eq!(sensor.recv_timeout(LONG).unwrap(), [&[9][..], &1.5_f64.to_le_bytes()].concat());
    // JSON of a schema.
    let mut position = controller.subscriber("position").unwrap();
    assert_eq!(rover.text(&["pub", "sensor.position", "{latitude: 0.1, fix: 3d}"]), "");
    assert_eq!(position.recv_timeout(LONG).unwrap(), r#"{"latitude":0.1,"fix":"3d"}"#);
    // Bytes.
    let mut images = logger.subscriber("images").unwrap();
    assert_eq!(rover.text(&["pub", "sensor.image", "{hex: 00ff}"]), "");
    assert_eq!(images.recv_timeout(LONG).unwrap(), &[0, 255][..]);
}

#[test]
fn messages_are_repeated_at_a_rate() {
    let rover = Rover::stopped();
    let mut logger = open(&rover, "logger");
    let mut events = logger.puller("events").unwrap();
    let started = Instant::now();
    rover.text(&["pub", "sensor.log", "{text: again}", "-n", "6", "--rate", "50"]);
    assert!(started.elapsed() >= Duration::from_millis(100));
    for _ in 0..6 {
        assert_eq!(events.recv_timeout(LONG).unwrap(), event("again"));
    }
    assert_eq!(events.try_recv().unwrap(), None);
}

#[test]
fn messages_of_standard_input_are_sent_one_by_one() {
    let rover = Rover::stopped();
    let mut logger = open(&rover, "logger");
    let mut events = logger.puller("events").unwrap();
    let mut process = rover.scl(&["pub", "sensor.log", "-"]).stdin(Stdio::piped()).spawn_guarded();
    let mut input = process.stdin.take().unwrap();
    input.write_all(b"{\"text\": \"one\"}\n").unwrap();
    // It is sent while the input is still open.
    assert_eq!(events.recv_timeout(LONG).unwrap(), event("one"));
    input.write_all(b"--- # a comment\ntext: two\n---\ntext: three\n").unwrap();
    drop(input);
    assert_eq!(events.recv_timeout(LONG).unwrap(), event("two"));
    assert_eq!(events.recv_timeout(LONG).unwrap(), event("three"));
    assert!(process.wait().unwrap().success());
}

#[test]
fn a_wrong_message_of_standard_input_is_named() {
    let rover = Rover::stopped();
    let mut logger = open(&rover, "logger");
    let mut events = logger.puller("events").unwrap();
    rover.write("messages.jsonl", "{text: one}\n{txt: two}\n{text: three}\n");
    let input = std::fs::File::open(rover.path("messages.jsonl")).unwrap();
    let output = rover.scl(&["pub", "sensor.log", "-"]).stdin(input).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    expect![[r#"
        error: message `rover.Event` has no field `txt`
         --> message 2 of standard input
          = help: did you mean `text`?
          = note: its fields: `text`
    "#]]
    .assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!(events.recv_timeout(LONG).unwrap(), event("one"));
    assert_eq!(events.try_recv().unwrap(), None);
}

#[test]
fn without_a_topology_file_the_peers_know_the_gate() {
    let mut rover = Rover::start();
    rover.stop("logger");
    let mut logger = open(&rover, "logger");
    let mut events = logger.puller("events").unwrap();
    events.recv_timeout(LONG).unwrap();
    rover.kill("sensor");
    // The killed process has left its announcement; one that was closed has not.
    for text in ["dead", "stopped"] {
        let output = elsewhere(&rover, &["pub", "sensor.log", &format!("{{text: {text}}}")]).output().unwrap();
        assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
        while events.recv_timeout(LONG).unwrap() != event(text) {}
    }
    let error = elsewhere(&rover, &["pub", "sensor.nothing", "{}"]).output().unwrap();
    assert_eq!(error.status.code(), Some(2));
    expect![[r#"
        error: component `sensor` has no gate `nothing`
          = note: gates that it or its running peers know: `sensor.measurements`, `sensor.position`, `sensor.log`, `sensor.image`
    "#]].assert_eq(&String::from_utf8(error.stderr).unwrap());
}

#[test]
fn a_running_component_is_not_played() {
    let rover = Rover::start();
    let error = rover.error(&["pub", "sensor.measurements", "{speed: 1}"], 2);
    let expected = format!("already running as process {}\n", rover.process_id("sensor"));
    assert!(error.contains(&expected) && error.contains("  = help: "), "{error}");
}

#[test]
fn missing_peers_are_named() {
    let rover = Rover::stopped();
    let error = rover.error(&["pub", "sensor.measurements", "{speed: 1}", "--ready", "100ms"], 2);
    expect![[r#"
        error: `sensor.measurements` is not connected to its peers after 100ms; nothing was sent
          = help: start them, or wait longer with `--ready TIME`
          = note: `controller.sensor` is not running
    "#]]
    .assert_eq(&error);
}

#[test]
fn mistakes_say_what_to_write() {
    let rover = Rover::stopped();
    let check = |arguments: &[&str], expected: expect_test::Expect| {
        expected.assert_eq(&rover.error(&[&["pub"], arguments].concat(), 2));
    };
    check(
        &["sensor.measurements", "{sped: 1}"],
        expect![[r#"
        error: message `rover.Measurement` has no field `sped`
          = help: did you mean `speed`?
          = note: its fields: `speed`, `count`
    "#]],
    );
    check(
        &["sensor.measurements", "{speed: fast}"],
        expect![[r#"
        error: field `speed`: expected a number (double), found the text `fast`
    "#]],
    );
    check(
        &["sensor.measurements", "{speed: 1"],
        expect![[r#"
        error: this message is not valid YAML or JSON: did not find expected ',' or '}' at line 2 column 1, while parsing a flow mapping
          = help: write for example '{speed: 1.0, unit: m/s}', quoted for the shell
    "#]],
    );
    check(
        &["sensor.measurement", "{}"],
        expect![[r#"
        error: component `sensor` has no gate `measurement`
          = help: did you mean `sensor.measurements`?
          = note: its gates: `sensor.measurements`, `sensor.position`, `sensor.image`, `sensor.log`
    "#]],
    );
    check(
        &["senor.measurements", "{}"],
        expect![[r#"
        error: system `rover` has no component `senor`
          = help: did you mean `sensor`?
          = note: components in `topology.yaml`: `sensor`, `controller`, `logger`, `user_interface`, `actuator`
    "#]],
    );
    check(
        &["sensor", "{}"],
        expect![[r#"
        error: `sensor` is not the name of a gate
          = help: write `component.gate`
    "#]],
    );
    check(
        &["controller.sensor", "{}"],
        expect![[r#"
        error: `controller.sensor` is a `sub` gate and sends no messages by itself
          = help: it receives from `sensor.measurements`: send there
    "#]],
    );
    check(
        &["controller.commands", "{}"],
        expect![[r#"
        error: `controller.commands` is a `rep` gate and sends no messages by itself
          = help: `scl call controller.commands REQUEST` sends it a request
    "#]],
    );
    check(
        &["user_interface.commands", "{}"],
        expect![[r#"
        error: `user_interface.commands` is a `req` gate and sends no messages by itself
          = help: `scl call controller.commands REQUEST --as user_interface` sends its requests
    "#]],
    );
    check(
        &["sensor.measurements", "{}", "--rate", "0"],
        expect![[r#"
        error: invalid value '0' for '--rate <HZ>': expected messages per second, from 0.000001 to 1000000

        For more information, try '--help'.
    "#]],
    );
    check(
        &["sensor.measurements", "{}", "--topology", "other.yaml"],
        expect![[r#"
        error: [SCL0001] cannot find the topology file `other.yaml`

        error: the topology `other.yaml` cannot be used
          = help: correct the errors above, or choose another file with `--topology FILE`
    "#]],
    );
}
