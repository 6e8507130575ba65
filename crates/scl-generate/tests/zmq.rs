//! The configuration for programs with only a ZeroMQ library.

use crate::fixture::{generated, repository, topology};
use expect_test::expect_file;
use scl_generate::{Format, Target};
use std::collections::BTreeSet;

#[test]
fn the_sockets_of_every_kind_are_as_expected() {
    let json = generated(&topology("every_kind.yaml"), Target::Zmq(Format::Json)).remove(0);
    assert_eq!(json.name, "every_kind.zmq.json");
    expect_file!["expected/every_kind.zmq.json"].assert_eq(&json.text);
    let yaml = generated(&topology("every_kind.yaml"), Target::Zmq(Format::Yaml)).remove(0);
    assert_eq!(yaml.name, "every_kind.zmq.yaml");
    expect_file!["expected/every_kind.zmq.yaml"].assert_eq(&yaml.text);
    let [json, yaml]: [serde_json::Value; 2] =
        [serde_json::from_str(&json.text).unwrap(), serde_yaml::from_str(&yaml.text).unwrap()];
    assert_eq!(json, yaml);
}

/// `docs/generate.md` explains every field, and no other.
#[test]
fn the_format_is_documented() {
    let page = std::fs::read_to_string(repository().join("docs/generate.md")).unwrap();
    let section = page.split("\n## ").find(|section| section.starts_with("ZeroMQ")).unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    let names = rows.filter_map(|line| line.split('|').nth(1)).flat_map(|cell| cell.split(','));
    let documented: BTreeSet<&str> = names.map(|name| name.trim().trim_matches('`')).collect();
    let json = generated(&topology("every_kind.yaml"), Target::Zmq(Format::Json)).remove(0).text;
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    let mut printed = BTreeSet::new();
    printed.extend(keys(&document));
    for (_, component) in document["components"].as_object().unwrap() {
        printed.extend(keys(component));
        for (_, gate) in component["gates"].as_object().unwrap() {
            printed.extend(keys(gate).chain(keys(&gate["payload"])));
        }
    }
    assert_eq!(documented, printed);
}

fn keys(value: &serde_json::Value) -> impl Iterator<Item = &str> {
    value.as_object().into_iter().flat_map(|object| object.keys().map(String::as_str))
}
