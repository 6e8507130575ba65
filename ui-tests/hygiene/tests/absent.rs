//! Types of the schemas and Rust types in one file, and a program that does not know the types of every component.
#![deny(warnings)]

pub mod nav {
    #[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Fix {
        pub latitude: f64,
    }
}

#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Plain;

wires::topology!("absent.yaml");

#[test]
fn a_component_opens_without_the_types_of_the_others() {
    let (mut gps, mut peer) = Gps::test_blocking().expect("a component");
    gps.fix.send_blocking(&nav::Fix { latitude: 47.5 }).expect("sent");
    assert_eq!(peer.fix.recv_blocking().expect("received"), nav::Fix { latitude: 47.5 });
    gps.status.send_blocking(&rover::Status {}).expect("sent");
    assert_eq!(peer.status.recv_blocking().expect("received"), rover::Status {});
    let _: &mut wires::Pub<Plain> = &mut gps.plain;
    let _: &mut wires::Pub<String> = &mut gps.text;
}

#[test]
fn the_specification_of_every_component_is_there() {
    use wires::Component;
    let payloads: Vec<&str> = Camera::SPEC.gates.iter().map(|gate| gate.payload).collect();
    let expected = [
        "camera_messages.v1.Image",
        "camera_messages.Command -> rover.Status",
        "Absent",
        "crate.nav.Absent",
        "bytes.Absent",
    ];
    assert_eq!(payloads, expected);
    assert_eq!(Logger::SPEC.gates[0].payload, "navigation.Fix");
}

mod twice {
    use super::nav;

    wires::topology!("twice.yaml", only = [gps]);
    wires::topology!("twice.yaml", only = [logger]);

    #[test]
    fn components_of_one_file_are_generated_by_two_calls() {
        use wires::Component;
        fn gate(gps: &mut Gps) -> &mut wires::Pub<nav::Fix> {
            &mut gps.fix
        }
        let _ = gate;
        assert_eq!((Gps::SPEC.name, Logger::SPEC.name), ("gps", "logger"));
    }
}
