//! `scl info`: a gate, a component, and what does not exist.

use crate::rover::{COMPONENTS, Rover};
use expect_test::{Expect, expect};
use serde_json::json;
use std::ops::Range;

/// A text with each number as `0`, with one unit for all rates, and with single spaces where columns depend on numbers.
fn normalized(text: &str) -> String {
    let mut shown = String::new();
    // Shown if there are any, which depends on the machine: the controller reads too slowly on a busy one.
    for line in text.lines().filter(|line| !line.starts_with("  replaced ")) {
        let indent = &line[..line.len() - line.trim_start().len()];
        let words = line.split_whitespace().map(|word| {
            let (number, rest) =
                word.split_at(word.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(word.len()));
            match rest {
                "KiB/s" | "MiB/s" => "B/s".to_owned(),
                _ if number.is_empty() => word.to_owned(),
                _ => format!("0{rest}"),
            }
        });
        shown += &format!("{indent}{}\n", words.collect::<Vec<_>>().join(" "));
    }
    shown
}

#[track_caller]
fn check(rover: &Rover, name: &str, expected: &Expect) {
    rover.wait_for(&["info", name], |info| info["rate"]["messages_per_s"].as_f64().filter(|rate| *rate > 1.0));
    let text = rover.text(&["info", name]);
    assert!(text.lines().all(|line| line.starts_with("  program") || line.chars().count() <= 80), "{text}");
    expected.assert_eq(&normalized(&text));
}

#[test]
fn gates_are_shown_with_their_peers() {
    let rover = Rover::start();
    check(
        &rover,
        "controller.sensor",
        &expect![[r#"
        controller.sensor
          component controller, running
          kind sub
          type rover.Measurement
          codec protobuf
          queue 0, drop_oldest
          max_size 0 MiB
          contract hl75aqsl
          declared topology.yaml:14:9
          rate 0/s, 0 B/s
          received 0, last 0 s ago
          waiting 0
          dropped 0

          PEER CONNECTED QUEUE WAITING TAKEN REPLACED DROPPED LOST
          sensor.measurements yes 0 0 0 0 0 0
    "#]],
    );
    check(
        &rover,
        "sensor.image",
        &expect![[r#"
        sensor.image
          component sensor, running
          kind pub
          type bytes
          codec raw
          max_size 0 MiB
          contract rqhnei4n
          declared topology.yaml:10:9
          tap sensor.image.tap
          rate 0/s, 0 B/s
          sent 0, last 0 s ago
          waiting 0
          dropped 0

          PEER CONNECTED QUEUE WAITING TAKEN REPLACED DROPPED LOST
          logger.images yes 0 0 0 0 0 0
    "#]],
    );
    check(
        &rover,
        "user_interface.commands",
        &expect![[r#"
        user_interface.commands
          component user_interface, running
          kind req
          type rover.Command -> rover.Status
          codec protobuf
          timeout 0s
          max_size 0 MiB
          contract wfqclrav
          declared topology.yaml:25:9
          rate 0/s, 0 B/s
          sent 0, last 0 s ago
          waiting 0
          dropped 0

          PEER CONNECTED QUEUE WAITING TAKEN REPLACED DROPPED LOST
          controller.commands yes 0 0 0 0 0 0
    "#]],
    );
}

#[test]
fn components_are_shown_with_their_gates() {
    let rover = Rover::start();
    let text = rover.text(&["info", "controller"]);
    assert!(text.contains(&format!("process   {}\n", rover.process_id("controller"))), "{text}");
    let table = text.split_once("\n\n").unwrap().1;
    expect![[r#"
        GATE KIND TYPE CODEC MSG/S DROPS PEERS
        sensor sub rover.Measurement protobuf 0 0 0/1
        position sub rover.Position json 0 0 0/1
        actuator pub rover.Setpoint protobuf 0 0 0/1
        commands rep rover.Command -> rover.Status protobuf 0 0 0/1
        log push rover.Event protobuf 0 0 0/1
    "#]]
    .assert_eq(&normalized(table));
}

#[test]
fn the_transports_of_a_gate_are_shown_where_they_were_chosen() {
    let rover = Rover::start_with(&COMPONENTS, |command| {
        command.env("SCL_TRANSPORT", "ipc,sensor.measurements=tcp");
    });
    let shown = |gate: &str| {
        let json = rover.json(&["info", gate, "--format", "json"]);
        (rover.text(&["info", gate]).contains("  transport  tcp\n"), json["transports"].clone())
    };
    let tcp = json!([{"name": "tcp", "peers": ["controller.sensor"]}]);
    assert_eq!(shown("sensor.measurements"), (true, tcp));
    assert_eq!(shown("sensor.image"), (false, json!([{"name": "ipc", "peers": ["logger.images"]}])));
    assert_eq!(shown("controller.sensor"), (false, json!([])), "it only connects");
}

#[test]
fn rates_are_those_of_the_senders() {
    let rover = Rover::start();
    // The senders send at 50 Hz at most. A receiver that was held up receives faster for a moment, and a rate of two
    // readings that were held up is too high or too low: a wrong rate is one that stays wrong.
    let rate = |gate: &str, expected: Range<f64>| {
        rover.wait_for(&["info", gate], |info| {
            let rate = |name: &str| info["rate"][name].as_f64();
            rate("messages_per_s").filter(|rate| expected.contains(rate)).zip(rate("bytes_per_s"))
        })
    };
    for gate in ["sensor.measurements", "controller.sensor", "controller.commands", "user_interface.commands"] {
        rate(gate, 1.0..60.0);
    }
    rate("logger.events", 1.0..120.0); // of two senders
    let (messages, bytes) = rate("sensor.image", 1.0..60.0);
    assert_eq!(bytes / messages, 1024.0);
}

#[test]
fn without_figures_the_rest_is_shown() {
    let rover = Rover::start_with(&COMPONENTS, |command| {
        command.env("SCL_STATS", "off");
    });
    let text = rover.text(&["info", "sensor.measurements"]);
    assert!(text.contains("figures    none: the program runs with `SCL_STATS=off`\n"), "{text}");
    assert!(text.contains("controller.sensor  ?"), "{text}");
    let info = rover.json(&["info", "sensor.measurements", "--format", "json"]);
    assert!(info["figures"].is_null() && info["rate"].is_null() && info["peers"][0]["connected"].is_null());
}

#[test]
fn a_component_that_hangs_is_marked() {
    let rover = Rover::start();
    crate::system::kill("-STOP", rover.process_id("sensor"));
    rover.wait_for(&["list"], |list| list["components"][3]["silent_for_s"].as_f64());
    let list = rover.text(&["list"]);
    assert!(list.lines().any(|line| line.starts_with("sensor          hangs  ")), "{list}");
    let info = rover.text(&["info", "sensor.measurements"]);
    assert!(info.contains("component  sensor, hangs for "), "{info}");
    assert!(info.contains("unknown: no second reading of the figures"), "{info}");
}

#[test]
fn a_killed_component_is_still_known() {
    let mut rover = Rover::start();
    rover.kill("sensor");
    let text = rover.text(&["info", "sensor.measurements"]);
    assert!(text.contains("component  sensor, dead\n"), "{text}");
    assert!(text.contains("type       rover.Measurement\n"), "{text}");
}

#[test]
fn what_does_not_exist_gets_a_suggestion() {
    let rover = Rover::start();
    for (name, expected) in [
        ("sensr", "error: system `rover` has no component `sensr`\n  = help: did you mean `sensor`?\n"),
        ("sensor.image2", "error: component `sensor` has no gate `image2`\n  = help: did you mean `sensor.image`?\n"),
        (
            "sensor.commands",
            "gate `commands`\n  = help: did you mean `controller.commands`?\n  = note: its gates: `sensor.",
        ),
        ("actuator", "error: component `actuator` is not running\n  = help: `scl list` shows what runs\n"),
        ("x\u{1b}.y", "error: system `rover` has no component `x\\u{1b}`\n"),
        ("", "error: system `rover` has no component ``\n"),
    ] {
        let error = rover.error(&["info", name], 2);
        assert!(error.contains(expected), "{error}");
    }
}
