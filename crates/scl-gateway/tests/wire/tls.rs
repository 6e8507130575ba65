//! TLS: who gets in, and who does not.

use std::path::Path;
use std::time::Duration;

use rcgen::{CertificateParams, date_time_ymd};
use scl_gateway::keys::HostFiles;
use scl_gateway::wire::{Neighbour, Wire, WireError, WireOptions};
use zenoh::Wait;

use super::certificates::Authority;
use super::network::*;
use super::proxy::{Proxy, Weather};

fn with_tls(options: WireOptions, tls: HostFiles) -> WireOptions {
    let routes =
        vec![route("board", "ground", "pose"), route("ground", "board", "image"), requests("board", "ground", "mode")];
    WireOptions { tls: Some(tls), routes, ..options }
}

async fn ground(address: &str, tls: HostFiles) -> Wire {
    Wire::open(with_tls(options("ground", Some(address), &[("board", None)]), tls)).await.expect("ground")
}

async fn board(via: &str, tls: HostFiles) -> Wire {
    Wire::open(with_tls(options("board", None, &[("ground", Some(via))]), tls)).await.expect("board")
}

#[tokio::test]
async fn hosts_with_certificates_exchange_everything_that_their_routes_allow() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    let address = free_address();
    let proxy = Proxy::to(&address).await;
    let ground = ground(&address, authority.host(folder.path(), "ground")).await;
    let board = board(&proxy.address, authority.host(folder.path(), "board")).await;
    let (mut up, mut up_end) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    let (mut down, mut down_end) = connected(&route("ground", "board", "image"), &ground, &board).await;
    let (_, _, arrived_up, arrived_down) = tokio::join!(
        send_all(&mut up, numbered(100)),
        send_all(&mut down, numbered(100)),
        receive(&mut up_end, 100),
        receive(&mut down_end, 100),
    );
    assert!(arrived_up == numbered(100) && arrived_down == numbered(100));
    super::requests::one_request(&board, &ground).await;
    let _announced = board.announce("board_program", numbered(7)[6].clone());
    let started = neighbour_that(&ground, |event| matches!(event, Neighbour::Started { .. })).await;
    assert!(matches!(started, Neighbour::Started { content, .. } if content == numbered(7)[6]));
    proxy.set(Weather::Cut);
    neighbour_that(&ground, |event| matches!(event, Neighbour::Disconnected { .. })).await;
    proxy.set(Weather::Good);
    let (given_up, arrived) = tokio::join!(send_all(&mut up, numbered(10)), async {
        let mut arrived = Vec::new();
        while arrived.len() < 10 {
            if let scl_gateway::wire::ReceiverEvent::Message(message) = received(&mut up_end).await {
                arrived.push(message);
                up_end.acknowledge(100 + arrived.len() as u64);
            }
        }
        arrived
    });
    assert!(given_up == 0 && arrived == numbered(10));
}

fn expired(params: &mut CertificateParams) {
    params.not_before = date_time_ymd(2020, 1, 1);
    params.not_after = date_time_ymd(2021, 1, 1);
}

/// Both hosts try three times, and neither sees the other.
async fn assert_refused(ground_files: HostFiles, board_files: HostFiles) {
    let address = free_address();
    let proxy = Proxy::to(&address).await;
    let ground = ground(&address, ground_files).await;
    let board = board(&proxy.address, board_files).await;
    let mut closed = proxy.closed();
    tokio::select! {
        event = neighbour(&ground) => panic!("ground sees {event:?}"),
        event = neighbour(&board) => panic!("board sees {event:?}"),
        three = closed.wait_for(|closed| *closed >= 3) => drop(three.expect("the proxy runs")),
    }
}

#[tokio::test]
async fn expired_certificates_are_refused_on_either_side() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    let good = |host| authority.host(folder.path(), host);
    let bad = |host| authority.host_with(folder.path(), host, "127.0.0.1", expired);
    assert_refused(good("ground"), bad("board")).await;
    assert_refused(bad("ground"), good("board")).await;
}

#[tokio::test]
async fn certificates_of_another_authority_are_refused_on_either_side() {
    let folder = tempfile::tempdir().expect("a folder");
    let (authority, other) = (Authority::new(), Authority::new());
    // Trusts the right authority, but is signed by another one.
    let foreign = |host: &str| {
        let path = folder.path().join(format!("foreign-{host}"));
        std::fs::create_dir_all(&path).expect("a folder");
        HostFiles { authority: authority.host(folder.path(), host).authority, ..other.host(&path, host) }
    };
    assert_refused(authority.host(folder.path(), "ground"), foreign("board")).await;
    assert_refused(foreign("ground"), authority.host(folder.path(), "board")).await;
}

#[tokio::test]
async fn a_certificate_for_another_address_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    let elsewhere = authority.host_with(folder.path(), "ground", "192.0.2.1", |_| ());
    assert_refused(elsewhere, authority.host(folder.path(), "board")).await;
}

#[tokio::test]
async fn a_missing_client_certificate_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    let address = free_address();
    let proxy = Proxy::to(&address).await;
    let files = authority.host(folder.path(), "ground");
    let _ground = ground(&address, files.clone()).await;
    let config = serde_json::json!({
        "mode": "peer",
        "connect": { "endpoints": [format!("tls/{}", proxy.address)], "retry": { "period_init_ms": 50, "period_max_ms": 50, "period_increase_factor": 1.0 } },
        "open": { "return_conditions": { "connect_scouted": false, "declares": false } },
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "listen": { "endpoints": [] },
        "transport": { "link": { "tls": { "root_ca_certificate": files.authority } } },
    });
    let config = zenoh::Config::from_json5(&config.to_string()).expect("a configuration");
    let (opened, is_open) = tokio::sync::oneshot::channel();
    let (finish, finished) = std::sync::mpsc::channel::<()>();
    let thread = std::thread::spawn(move || {
        let session = zenoh::open(config).wait().expect("a session");
        let _ = opened.send(());
        let _ = finished.recv();
        let peers = session.info().peers_zid().wait().count();
        session.close().wait().expect("close");
        peers
    });
    is_open.await.expect("the thread runs");
    let mut closed = proxy.closed();
    let _ = closed.wait_for(|closed| *closed >= 3).await.expect("the proxy runs");
    drop(finish);
    assert_eq!(thread.join().expect("the thread ends"), 0, "a peer without a certificate was accepted");
}

#[tokio::test]
async fn files_that_are_no_certificates_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = Authority::new().host(folder.path(), "ground");
    let missing = Path::new("/nowhere/key.pem").to_owned();
    let swapped = HostFiles { key: good.certificate.clone(), ..good.clone() };
    for (files, word) in [(HostFiles { key: missing, ..good.clone() }, "/nowhere/key.pem"), (swapped, "private key")] {
        let options = with_tls(options("ground", Some(&free_address()), &[("board", None)]), files);
        let error = Wire::open(options).await.expect_err(word);
        assert!(matches!(&error, WireError::Certificates { reason, .. } if reason.contains(word)), "{error}");
    }
}

#[tokio::test]
async fn a_late_link_still_gets_through_the_handshake() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    let address = free_address();
    let proxy = Proxy::to(&address).await;
    proxy.set(Weather::Delayed(Duration::from_millis(100)));
    let ground = ground(&address, authority.host(folder.path(), "ground")).await;
    let board = board(&proxy.address, authority.host(folder.path(), "board")).await;
    connected(&route("board", "ground", "pose"), &board, &ground).await;
}
