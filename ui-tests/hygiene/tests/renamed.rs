//! The dependency has another name, nothing else of SCL is named, and not even an unused item may warn.
#![deny(warnings)]
#![allow(deprecated, reason = "the file has a component without gates, on purpose")]

use wires::Component;
use wires::private::prost::Message;

wires::topology!("rover.yaml");

#[test]
fn specifications_tell_the_wiring() {
    let gates: Vec<&str> = Controller::SPEC.gates.iter().map(|gate| gate.name).collect();
    assert_eq!(gates, ["sensor", "axis", "bytes", "commands", "work"]);
    let connection = &Controller::SPEC.gates[0].connections[0];
    assert_eq!((connection.peer_component, connection.peer_gate, connection.queue), ("sensor", "measurements", 1));
    assert_eq!(UserInterface::SPEC.gates[0].options.timeout.as_millis(), 500);
    assert!(!Controller::SPEC.gates[3].connections[0].required, "an optional component is not waited for");
    assert!(Logger::SPEC.gates.is_empty());
}

#[test]
fn both_ends_of_a_connection_know_how_large_a_message_may_be() {
    let (asking, answering) = (&UserInterface::SPEC.gates[0], &Controller::SPEC.gates[3]);
    assert_eq!((asking.options.max_size, asking.connections[0].max_size), (512, 4096));
    assert_eq!((answering.options.max_size, answering.connections[0].max_size), (4096, 512));
    assert_eq!(Sensor::SPEC.gates[0].connections[0].max_size, 64 << 20);
}

#[test]
fn listening_gates_have_a_tap() {
    let taps: Vec<&str> = Controller::SPEC.gates.iter().map(|gate| gate.tap).collect();
    assert_eq!(taps, ["", "", "", "controller.commands.tap", ""]);
    assert_eq!(Sensor::SPEC.gates[0].tap, "sensor.measurements.tap");
    assert_eq!((Sensor::SPEC.gates[0].endpoint, UserInterface::SPEC.gates[1].tap), ("", "user_interface.work.tap"));
}

#[test]
fn programs_embed_the_descriptors_of_their_messages() {
    let files = |spec: &wires::spec::ComponentSpec| {
        let schema = spec.schema.as_ref()?;
        let set = wires::private::prost_types::FileDescriptorSet::decode(schema.descriptors).expect("descriptors");
        Some(set.file.into_iter().map(|file| file.name.unwrap_or_default()).collect::<Vec<_>>())
    };
    // Imports come first, and every file that a message needs is there.
    let expected = ["google/protobuf/timestamp.proto", "level.proto", "rover.proto"];
    assert_eq!(files(Controller::SPEC).expect("a schema"), expected);
    assert_eq!(files(Sensor::SPEC).expect("a schema"), expected);
    assert_eq!(files(Logger::SPEC), None);
}

#[test]
fn generated_messages_travel() {
    let axis =
        rover::measurement::ImuAxis { kind: rover::measurement::imu_axis::Kind::Angular.into(), samples: vec![1.5] };
    let source = Some(rover::measurement::Source::Axis(axis.clone()));
    let axes = [("x".to_owned(), axis)].into();
    let sent = rover::Measurement { at: Some(Default::default()), axes, source, raw: Some(vec![7]) };
    let received = rover::Measurement::decode(sent.encode_to_vec().as_slice());
    assert_eq!(received, Ok(sent));
    assert_eq!(rover::v1::Type { level: 1 }.level(), rover::v1::Level::High);
}
