//! A host with a valid certificate does everything that is not its own. The network library is used directly, because a
//! gateway would not even try. Each test runs a second time without the access list, where everything must arrive.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};

use zenoh::liveliness::LivelinessToken;
use zenoh::matching::MatchingStatus;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::{Config, Session, Wait};

use self::certificates::Authority;
use super::*;
use crate::keys::HostFiles;
use crate::route::RouteEnd;
use crate::wire::Peer;
use crate::wire::config::config;

#[path = "../../../tests/wire/certificates.rs"]
mod certificates;

fn route(from: &str, to: &str, pattern: Pattern) -> Route {
    let end = |host: &str| RouteEnd { host: host.to_owned(), component: None, gate: None };
    Route {
        pattern,
        from: end(from),
        to: end(to),
        endpoint: String::new(),
        queue: 1,
        lossless: false,
        latched: false,
        max_size: 1,
        key: format!("scl/system/{from}/out/{to}/in/c0"),
    }
}

fn routes() -> Vec<Route> {
    let messages = Pattern::Messages { listens_at_sender: true };
    vec![
        route("board", "ground", messages),
        route("ground", "board", messages),
        route("tower", "ground", messages),
        route("ground", "tower", messages),
        route("ground", "air", Pattern::Requests),
    ]
}

/// The configuration of `ground`, to which all others connect, or of another host.
fn json(host: &str, address: &str, tls: HostFiles) -> Value {
    let others = ["air", "board", "ground", "tower"].into_iter().filter(|other| *other != host);
    let is_ground = host == "ground";
    let peers = others
        .filter(|other| is_ground || *other == "ground")
        .map(|other| Peer { host: other.to_owned(), address: (!is_ground).then(|| address.to_owned()) });
    let options = WireOptions {
        system: "system".to_owned(),
        host: host.to_owned(),
        listen: is_ground.then(|| address.to_owned()),
        peers: peers.collect(),
        tls: Some(tls),
        insecure: false,
        routes: routes(),
        components: BTreeMap::new(),
    };
    config(&options).expect("valid options")
}

/// `ground` with a changed access list, and `board`, which keeps to nothing.
fn sessions(folder: &Path, access: impl FnOnce(&mut Value)) -> (Session, Session) {
    let authority = Authority::new();
    let address = scl_tests::free_address();
    let open = |json: Value| {
        let config = Config::from_json5(&json.to_string()).expect("a configuration");
        zenoh::open(config).wait().expect("a session")
    };
    let mut ground = json("ground", &address.to_string(), authority.host(folder, "ground"));
    access(&mut ground["access_control"]);
    let mut board = json("board", &address.to_string(), authority.host(folder, "board"));
    board["access_control"] = json!({ "enabled": false, "default_permission": "allow" });
    (open(ground), open(board))
}

fn off(access: &mut Value) {
    *access = json!({ "enabled": false, "default_permission": "allow" });
}

/// Allows everything in one direction, so that only the other one is tested.
fn open_flow(access: &mut Value, flow: &str) {
    let everything = json!({
        "id": "everything", "permission": "allow", "flows": [flow],
        "messages": [
            "put", "delete", "declare_subscriber", "query", "declare_queryable", "reply", "liveliness_token",
            "declare_liveliness_subscriber", "liveliness_query",
        ],
        "key_exprs": EVERYTHING,
    });
    access["rules"].as_array_mut().expect("rules").push(everything);
    let policy = json!({ "id": "everything", "rules": ["everything"], "subjects": ["board"] });
    access["policies"].as_array_mut().expect("policies").push(policy);
}

/// Wildcards do not match what begins with `@`.
const EVERYTHING: [&str; 7] = [
    "scl/**",
    "scl/**/@ack",
    "scl/**/@replies",
    "scl/**/@replies/@ack",
    "scl/*/@mark/**",
    "scl/*/@host/**",
    "scl/*/@component/**",
];

fn system(key: &str) -> String {
    format!("scl/system/{key}")
}

fn subscribe(session: &Session, key: &str, seen: &Sender<String>) -> Subscriber<()> {
    let seen = seen.clone();
    let callback = move |sample: zenoh::sample::Sample| drop(seen.send(sample.key_expr().to_string()));
    session.declare_subscriber(key.to_owned()).callback(callback).wait().expect("a subscriber")
}

/// What has arrived when the last key has.
fn until(seen: &Receiver<String>, last: &str) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    while keys.last().is_none_or(|key| key != last) {
        keys.push(seen.recv().expect("the subscribers are there"));
    }
    keys
}

/// Waits until the other side is known to listen.
fn until_heard(publisher: &Publisher<'_>) {
    let (changed, changes) = channel();
    let tell = move |status: MatchingStatus| changed.send(status.matching()).unwrap_or_default();
    let _listener = publisher.matching_listener().callback(tell).wait().expect("a listener");
    let is_heard = publisher.matching_status().wait().expect("a status").matching();
    assert!(is_heard || changes.iter().any(|is_heard| is_heard));
}

/// Sends on all keys, once the other side is known to listen to each.
fn send(session: &Session, keys: &[String]) {
    for key in keys {
        let publisher = session.declare_publisher(key.clone()).wait().expect("a publisher");
        until_heard(&publisher);
        publisher.put("forged").wait().expect("put");
    }
}

#[test]
fn a_host_sends_only_what_its_components_send() {
    let forbidden = [
        system("tower/out/ground/in/c0"),
        system("ground/out/tower/in/c0"),
        system("ground/out/board/in/c0"),
        system("ground/out/tower/in/c0/@ack"),
        system("ground/out/air/in/c0/@replies"),
        system("board/out/ground/in/c1"),
        system("@mark/tower/ground"),
    ];
    let own = [system("ground/out/board/in/c0/@ack"), system("board/out/ground/in/c0")];
    for (is_on, expected) in [(true, own.to_vec()), (false, [&forbidden[..], &own[..]].concat())] {
        let folder = tempfile::tempdir().expect("a folder");
        let (ground, board) =
            sessions(folder.path(), |access| if is_on { open_flow(access, "egress") } else { off(access) });
        let (sender, seen) = channel();
        let all = [&forbidden[..], &own[..]].concat();
        let _subscribers: Vec<_> = all.iter().map(|key| subscribe(&ground, key, &sender)).collect();
        send(&board, &all);
        assert_eq!(until(&seen, &own[1]), expected);
    }
}

#[test]
fn a_host_declares_only_its_own_tokens() {
    let forbidden = [
        system("tower/out/ground/in/c0/sender/1/2"),
        system("ground/out/tower/in/c0/receiver/1/2"),
        system("ground/out/board/in/c0/sender/1/2"),
        system("ground/out/air/in/c0/receiver/1/2"),
        system("@host/tower/1"),
        system("@component/program/tower/1/2"),
    ];
    let own = [
        system("ground/out/board/in/c0/receiver/1/2"),
        system("board/out/ground/in/c9/sender/1/2"),
        system("@component/program/board/1/2"),
        system("@host/board/1"),
    ];
    for (is_on, mut expected) in [(true, own.to_vec()), (false, [&forbidden[..], &own[..]].concat())] {
        let folder = tempfile::tempdir().expect("a folder");
        let (ground, board) =
            sessions(folder.path(), |access| if is_on { open_flow(access, "egress") } else { off(access) });
        let (sender, seen) = channel();
        let _subscribers = keys::tokens("system", "ground").map(|key| {
            let sender = sender.clone();
            ground
                .liveliness()
                .declare_subscriber(key)
                .history(true)
                .callback(move |token| drop(sender.send(token.key_expr().to_string())))
                .wait()
                .expect("a subscriber")
        });
        // Only once they are connected is the order kept.
        let _probe = subscribe(&ground, "scl/system/ground/out/board/in/c0/@ack", &sender);
        send(&board, &["scl/system/ground/out/board/in/c0/@ack".to_owned()]);
        until(&seen, "scl/system/ground/out/board/in/c0/@ack");
        let declare = |key: &String| board.liveliness().declare_token(key.clone()).wait().expect("a token");
        let _tokens: Vec<LivelinessToken> = [&forbidden[..], &own[..]].concat().iter().map(declare).collect();
        let mut arrived = until(&seen, &own[3]);
        arrived.sort();
        expected.sort();
        assert_eq!(arrived, expected);
    }
}

/// What counts is what may leave: the network library sends a host that has just connected everything, until it knows
/// what that host has declared, so refusing its declarations alone would not do.
#[test]
fn a_host_hears_only_what_is_for_it() {
    let secret = system("ground/out/tower/in/c0");
    let own = system("ground/out/board/in/c0");
    for (flow, expected) in [(Some("ingress"), vec![own.clone()]), (None, vec![secret.clone(), own.clone()])] {
        let folder = tempfile::tempdir().expect("a folder");
        let (ground, board) = sessions(folder.path(), |access| match flow {
            Some(flow) => open_flow(access, flow),
            None => off(access),
        });
        let (sender, seen) = channel();
        let _subscribers = [&secret, &own].map(|key| subscribe(&board, key, &sender));
        // The secret goes out once the own subscription is there, which was declared later.
        let publisher = ground.declare_publisher(own.clone()).wait().expect("a publisher");
        until_heard(&publisher);
        ground.put(secret.clone(), "secret").wait().expect("put");
        publisher.put("own").wait().expect("put");
        assert_eq!(until(&seen, &own), expected, "open: {flow:?}");
    }
}
