//! Components and messages of another crate.

use scl_message_tests::weather::Temperature;
use scl_message_tests::{Controller, ControllerPeer, Sensor, mean_speed, rover};

#[test]
fn components_of_a_library_are_opened_and_tested() {
    let (mut controller, mut peer): (Controller, ControllerPeer) = Controller::test_blocking().expect("a component");
    peer.sensor.send_blocking(&rover::Measurement { speed: 3.0 }).expect("sent");
    peer.temperature.send_blocking(&Temperature { celsius: 20.5 }).expect("sent");
    let measured = controller.sensor.recv_blocking().expect("received");
    assert_eq!(mean_speed(&[measured, rover::Measurement { speed: 1.0 }]), 2.0);
    let temperature: Temperature = controller.temperature.recv_blocking().expect("received");
    assert_eq!(temperature, Temperature { celsius: 20.5 });
    let _: fn() -> Result<Sensor, scl::OpenError> = Sensor::open_blocking;
}

#[test]
fn messages_of_schemas_are_serde_types() {
    #[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
    struct Record {
        at: u32,
        measured: rover::Measurement,
    }
    let record = Record { at: 1, measured: rover::Measurement { speed: 0.5 } };
    let text = serde_json::to_string(&record).expect("JSON");
    assert_eq!(text, r#"{"at":1,"measured":{"speed":0.5}}"#);
    assert_eq!(serde_json::from_str::<Record>(&text).expect("a record"), record);
}
