//! Announcements, and neighbours that must be refused.

use bytes::Bytes;
use scl_gateway::route::Route;
use scl_gateway::wire::{Neighbour, Wire, WireError, WireOptions};

use super::network::*;

fn is_component(event: &Neighbour) -> bool {
    matches!(event, Neighbour::Started { .. } | Neighbour::Stopped { .. })
}

#[tokio::test]
async fn announcements_of_any_length_cross_and_end() {
    let (board, ground) = two_hosts().await;
    for content in [Bytes::new(), Bytes::from_static(b"plan"), Bytes::from(vec![5; 3 << 20])] {
        let announced = board.announce("board_program", content.clone());
        let (component, host) = ("board_program".to_owned(), "board".to_owned());
        let started = Neighbour::Started { component: component.clone(), host: host.clone(), content };
        assert!(neighbour_that(&ground, is_component).await == started);
        drop(announced);
        assert_eq!(neighbour_that(&ground, is_component).await, Neighbour::Stopped { component, host });
    }
}

#[tokio::test]
async fn a_lost_host_stops_its_components() {
    let (board, ground) = two_hosts().await;
    let _announced = board.announce("board_program", Bytes::from_static(b"plan"));
    assert!(matches!(neighbour_that(&ground, is_component).await, Neighbour::Started { .. }));
    board.close().await;
    assert!(matches!(neighbour_that(&ground, is_component).await, Neighbour::Stopped { .. }));
}

#[tokio::test]
async fn another_hosts_component_is_refused() {
    let (board, ground) = two_hosts().await;
    let _announced = board.announce("ground_program", Bytes::from_static(b"plan"));
    let event = neighbour_that(&ground, |event| !matches!(event, Neighbour::Connected { .. })).await;
    let text = "host `board` claims the component `ground_program`, which is on host `ground`: refused".to_owned();
    assert_eq!(event, Neighbour::Refused { text });
}

#[tokio::test]
async fn another_systems_gateway_is_refused() {
    let address = free_address();
    let ground = Wire::open(options("ground", Some(&address), &[("board", None)])).await.expect("ground");
    let other = WireOptions { system: "other".to_owned(), ..options("board", None, &[("ground", Some(&address))]) };
    let _board = Wire::open(other).await.expect("board");
    let text = "the gateway of host `board` belongs to the system `other`, this one to `system`: refused".to_owned();
    assert_eq!(neighbour(&ground).await, Neighbour::Refused { text });
}

#[tokio::test]
async fn a_second_gateway_of_a_host_is_refused_until_the_first_ends() {
    let address = free_address();
    let (first, ground) = two_hosts_via(&address, &address).await;
    let route = route("board", "ground", "pose");
    let (mut sender, mut receiver) = connected(&route, &first, &ground).await;
    let second = Wire::open(options("board", None, &[("ground", Some(&address))])).await.expect("second");
    let mut intruder = second.sender(&route);
    intruder.set_open(true);
    let at_third = neighbour_that(&ground, |event| matches!(event, Neighbour::Refused { .. })).await;
    let text = "a second gateway of host `board` is connected, and refused until the first ends".to_owned();
    assert_eq!(at_third, Neighbour::Refused { text });
    let at_second = neighbour_that(&second, |event| matches!(event, Neighbour::Refused { .. })).await;
    let text = "host `ground` refuses this gateway: another gateway of host `board` is connected there".to_owned();
    assert_eq!(at_second, Neighbour::Refused { text });
    let (_, arrived) = tokio::join!(send_all(&mut sender, numbered(5)), receive(&mut receiver, 5));
    assert!(arrived == numbered(5));
    drop(sender);
    first.close().await;
    let (_, arrived) = tokio::join!(send_all(&mut intruder, numbered(6)), async {
        let mut arrived = Vec::new();
        while arrived.len() < 6 {
            if let scl_gateway::wire::ReceiverEvent::Message(message) = received(&mut receiver).await {
                arrived.push(message);
                receiver.acknowledge(5 + arrived.len() as u64);
            }
        }
        arrived
    });
    assert!(arrived == numbered(6));
}

#[tokio::test]
async fn another_contract_is_reported_on_both_sides() {
    let (board, ground) = two_hosts().await;
    let ours = route("board", "ground", "pose");
    let theirs = Route { key: ours.key.replace("/c0", "/c1"), ..ours.clone() };
    let (mut sender, mut receiver) = (board.sender(&ours), ground.receiver(&theirs));
    sender.set_open(true);
    receiver.set_open(true);
    let is_mismatch = |event: &Neighbour| matches!(event, Neighbour::Mismatch { .. });
    let text = |host: &str, there: &str, here: &str| {
        format!(
            "host `{host}` has the connection `board_program/pose/ground_program/pose` with contract {there}, \
             this host with {here}: a program or topology there or here is out of date"
        )
    };
    let (key, text_at_board) = (ours.key.clone(), text("ground", "c1", "c0"));
    assert_eq!(neighbour_that(&board, is_mismatch).await, Neighbour::Mismatch { key, text: text_at_board });
    let (key, text_at_ground) = (theirs.key.clone(), text("board", "c0", "c1"));
    assert_eq!(neighbour_that(&ground, is_mismatch).await, Neighbour::Mismatch { key, text: text_at_ground });
}

#[tokio::test]
async fn without_tls_only_loopback_is_accepted_unless_told_otherwise() {
    for address in ["0.0.0.0:7447", "192.0.2.1:7447", "[::]:7447", "board.example:7447"] {
        let error = Wire::open(options("board", Some(address), &[])).await.expect_err(address);
        assert!(matches!(error, WireError::NoTls { .. }), "{error}");
        let error = Wire::open(options("board", None, &[("ground", Some(address))])).await.expect_err(address);
        assert!(matches!(error, WireError::NoTls { .. }), "{error}");
    }
    for address in ["", "7447", "127.0.0.1", "127.0.0.1:port", "127.0.0.1:70000", "::1:7447", "127.0.0.1#iface=lo:1"] {
        let error = Wire::open(options("board", Some(address), &[])).await.expect_err(address);
        assert!(matches!(error, WireError::Address { .. }), "{error}");
    }
    let address = free_address().replace("127.0.0.1", "0.0.0.0");
    let insecure = WireOptions { insecure: true, ..options("board", Some(&address), &[]) };
    Wire::open(insecure).await.expect("insecure").close().await;
}

#[tokio::test]
async fn a_taken_address_is_named() {
    let address = free_address();
    let _first = Wire::open(options("ground", Some(&address), &[])).await.expect("first");
    let error = Wire::open(options("ground", Some(&address), &[])).await.expect_err("second");
    assert!(matches!(&error, WireError::Listen { address: named, .. } if *named == address), "{error}");
}
