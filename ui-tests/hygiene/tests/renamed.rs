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
    let link = &Controller::SPEC.gates[0].links[0];
    assert_eq!((link.peer_component, link.peer_gate, link.queue), ("sensor", "measurements", 1));
    assert_eq!(UserInterface::SPEC.gates[0].timeout.as_millis(), 500);
    assert!(!Controller::SPEC.gates[3].links[0].required, "an optional component is not waited for");
    assert!(Logger::SPEC.gates.is_empty());
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
