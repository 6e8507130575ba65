use std::collections::BTreeMap;

use zenoh::Config;

use super::*;

fn options() -> WireOptions {
    let peer = |host: &str| Peer { host: host.to_owned(), address: Some("127.0.0.1:7448".to_owned()) };
    WireOptions {
        system: "system".to_owned(),
        host: "board".to_owned(),
        listen: Some("127.0.0.1:0".to_owned()),
        peers: vec![peer("air"), peer("ground")],
        tls: None,
        insecure: false,
        routes: Vec::new(),
        components: BTreeMap::new(),
    }
}

/// The paths and values of all leaves, in the syntax of the network library.
fn leaves(path: &str, value: &Value, found: &mut Vec<(String, Value)>) {
    match value {
        // The library reads these as a whole.
        Value::Object(fields) if !["access_control", "connect/retry"].contains(&path) => {
            for (name, value) in fields {
                let separator = if path.is_empty() { "" } else { "/" };
                leaves(&format!("{path}{separator}{name}"), value, found);
            }
        }
        _ => found.push((path.to_owned(), value.clone())),
    }
}

#[test]
fn every_key_is_known_and_keeps_its_value() {
    let json = config(&options()).expect("valid options");
    let parsed = Config::from_json5(&json.to_string()).expect("known keys");
    let mut found = Vec::new();
    leaves("", &json, &mut found);
    assert!(found.len() > 35, "{found:?}");
    for (path, value) in found.into_iter().filter(|(path, _)| path != "access_control") {
        let kept: Value = serde_json::from_str(&parsed.get_json(&path).expect(&path)).expect("JSON");
        assert_eq!(kept, value, "{path}");
    }
}

#[test]
fn unknown_keys_are_errors() {
    for text in ["{nonsense: 1}", "{transport: {link: {tx: {leese: 1}}}}", "{transport: {link: {tls: {mtls: true}}}}"] {
        assert!(Config::from_json5(text).is_err(), "{text}");
    }
}

#[test]
fn of_two_hosts_exactly_one_connects() {
    let endpoints = |options: &WireOptions| config(options).expect("valid")["connect"]["endpoints"].clone();
    assert_eq!(endpoints(&options()), json!(["tcp/127.0.0.1:7448"]));
    let silent = WireOptions { listen: None, ..options() };
    assert_eq!(endpoints(&silent), json!(["tcp/127.0.0.1:7448", "tcp/127.0.0.1:7448"]));
}
