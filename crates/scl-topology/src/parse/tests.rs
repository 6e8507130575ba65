//! Whole files.
#![allow(clippy::unwrap_used)]

use super::testing::parse_text;
use crate::model::Model;
use expect_test::{Expect, expect};

/// Listing 1 of the paper, byte for byte.
const LISTING_1: &str = include_str!("../../tests/files/listing_1.yaml");

/// The same system with types, and every option and section.
const EVERY_KEY: &str = include_str!("../../tests/files/every_key.yaml");

/// The same shapes in flow style, as FLOW writes them.
const FLOW: &str = include_str!("../../tests/files/flow.json");

fn dump(model: &Model) -> String {
    let mut out = String::new();
    let value = |of: &Option<crate::source::Spanned<String>>| of.as_ref().map(|it| it.value.clone());
    let schemas: Vec<_> = model.schemas.iter().map(|it| &it.value).collect();
    out.push_str(&format!("{:?} {schemas:?} {:?}\n", value(&model.system), value(&model.codec)));
    for component in &model.components {
        let (name, optional) = (&component.name.value, if component.optional == Some(true) { " optional" } else { "" });
        out.push_str(&format!("{name}{optional} {:?}\n", value(&component.doc)));
        for gate in &component.gates {
            out.push_str(&format!("  {}: {} {:?}", gate.name.value, gate.kind.value, value(&gate.payload)));
            for option in &gate.options {
                let quote = if option.quoted { "'" } else { "" };
                out.push_str(&format!(" {}={quote}{}{quote}", option.key.value, option.value.value));
            }
            out.push('\n');
        }
    }
    for connection in &model.connections {
        out.push_str(&format!("{} - {}\n", connection.ends[0].value, connection.ends[1].value));
    }
    out
}

fn check_valid(text: &str, expected: Expect) {
    let mut dumps = Vec::new();
    let spellings =
        [text.to_owned(), text.replace('\n', "\r\n"), format!("\u{feff}{text}"), text.trim_end().to_owned()];
    for spelling in spellings {
        let (model, problems, _) = parse_text(&spelling);
        assert_eq!(problems, [], "{spelling}");
        dumps.push(dump(&model));
    }
    expected.assert_eq(&dumps[0]);
    assert!(dumps.iter().all(|other| *other == dumps[0]), "{dumps:#?}");
}

#[test]
fn listing_1() {
    check_valid(
        LISTING_1,
        expect![[r#"
        None [] None
        sensor None
          measurements: pub None
        actuator None
          setpoint: sub None
        controller None
          sensor: sub None
          actuator: pub None
          events: pub None
          commands: rep None
        user_interface None
          events: sub None
          commands: req None
        sensor.measurements - controller.sensor
        actuator.setpoint - controller.actuator
        controller.events - user_interface.events
        controller.commands - user_interface.commands
    "#]],
    );
}

#[test]
fn every_key() {
    check_valid(
        EVERY_KEY,
        expect![[r#"
            Some("rover") ["rover.proto"] Some("protobuf")
            sensor optional Some("Reads the inertial unit.")
              measurements: pub Some("rover.Measurement") rate=100Hz doc=One reading per period.
              log: pub Some("rover.Event")
            actuator None
              setpoint: sub Some("rover.Setpoint") queue=1
              log: pub Some("rover.Event")
            controller None
              sensor: sub Some("rover.Measurement") queue=1 deadline=20ms max_age=50ms
              actuator: pub None
              events: pub Some("rover.Event") backpressure=true codec=my_crate::Flat
              commands: rep Some("rover.Command -> rover.Status") unconnected=ok
              work: push Some("rover.Job") share=true period=1s
              log: pub Some("rover.Event")
            user_interface None
              events: sub Some("rover.Event") queue=1000 when_full=wait max_size=8MiB
              commands: req Some("rover.Command -> rover.Status") timeout=500ms
            left_motor optional Some("One motor with its controller.")
              setpoint: sub None
            right_motor optional Some("One motor with its controller.")
              setpoint: sub None
            sensor.measurements - controller.sensor
            actuator.setpoint - controller.actuator
            controller.actuator - left_motor.setpoint
            controller.actuator - right_motor.setpoint
            sensor.log - user_interface.events
            actuator.log - user_interface.events
            controller.log - user_interface.events
        "#]],
    );
}

#[test]
fn flow_style() {
    check_valid(
        FLOW,
        expect![[r#"
        Some("rover") [] None
        sensor None
          measurements: pub Some("rover.M") backpressure=true
        controller None
          sensor: sub None
          log: push Some("A")
        sensor.measurements - controller.sensor
    "#]],
    );
}

#[test]
fn spans_cover_what_is_written() {
    let (model, _, sources) = parse_text(EVERY_KEY);
    let events = &model.components[3].gates[0];
    let spans =
        [events.span, events.name.span, events.kind.span, events.options[0].value.span, model.connections[1].span];
    let texts: Vec<_> = spans.iter().map(|span| sources.snippet(*span)).collect();
    expect![[r#"
        [
            "events:\n          sub: rover.Event\n          queue: 1000\n          when_full: wait\n          max_size: 8MiB",
            "events",
            "sub",
            "1000",
            "- actuator.setpoint\n    - controller.actuator",
        ]
    "#]]
    .assert_debug_eq(&texts);
}
