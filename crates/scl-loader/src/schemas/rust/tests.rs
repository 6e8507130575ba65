//! Which names of schemas are refused, and which are not.

use crate::testing::{folder, load_from};
use expect_test::{Expect, expect};
use scl_topology::diagnostic::render;

/// The problems of a topology with the component `sensor` and these schemas: declarations of the package `rover`,
/// unless they start with another package or a comment.
fn told(schemas: &[&str]) -> Vec<(&'static str, String)> {
    let names: Vec<String> = (0..schemas.len()).map(|index| format!("{index}.proto")).collect();
    let package =
        |schema: &str| if schema.starts_with("package") || schema.starts_with("//") { "" } else { "package rover;" };
    let text = |schema: &&str| format!("syntax = \"proto2\";\n{}\n{schema}\n", package(schema));
    let texts: Vec<String> = schemas.iter().map(text).collect();
    let topology = format!("schemas: [{}]\nconnections: []\ncomponents:\n  - name: sensor\n", names.join(", "));
    let files = names.iter().map(String::as_str).zip(texts.iter().map(String::as_str));
    let files: Vec<(&str, &str)> = files.chain([("t.yaml", topology.as_str())]).collect();
    let loaded = load_from(&folder(&files), "t.yaml");
    let found = loaded.diagnostics.iter().filter(|problem| matches!(problem.code(), "SCL0406" | "SCL0417" | "SCL0418"));
    found.map(|problem| (problem.code(), problem.message.clone())).collect()
}

/// What is said about each of these groups of schemas, a line for each problem.
#[track_caller]
fn refused(groups: &[&[&str]], expected: Expect) {
    let mut lines = String::new();
    for schemas in groups {
        let told = told(schemas);
        assert!(!told.is_empty() && told.iter().all(|(code, _)| *code == "SCL0417"), "{schemas:?}: {told:?}");
        lines.extend(told.into_iter().map(|(_, message)| message + "\n"));
    }
    expected.assert_eq(&lines);
}

#[test]
fn both_places_are_shown() {
    let schema = "syntax = \"proto2\";\npackage rover;\nenum Mode { MODE_AUTO = 0; AUTO = 1; }\n";
    let topology = "schemas: [rover.proto]\nconnections: []\ncomponents: []\n";
    let loaded = load_from(&folder(&[("rover.proto", schema), ("t.yaml", topology)]), "t.yaml");
    let problem = loaded.diagnostics.iter().find(|problem| problem.code() == "SCL0417").unwrap();
    expect![[r#"
        error: [SCL0417] enum value `rover.MODE_AUTO` and enum value `rover.AUTO` would both become `Auto` in the Rust enum `rover::Mode`
         --> rover.proto:3:28
          |
        3 | enum Mode { MODE_AUTO = 0; AUTO = 1; }
          |             ---------      ^^^^ also becomes `Auto`
          |             |
          |             becomes `Auto`
          |
          = help: rename one of them
          = note: names are part of a message's JSON, but not of its protobuf bytes"#]].assert_eq(&render(problem, &loaded.sources));
}

#[test]
fn what_nothing_uses_can_be_removed() {
    let helps = |schema: &str| {
        let schema = format!("syntax = \"proto3\";\npackage rover;\n{schema}\n");
        let topology = "schemas: [rover.proto]\nconnections: []\ncomponents:\n  - name: sensor\n    gates:\n      \
                        - fixes: {pub: rover.Fix, unconnected: ok}\n";
        let loaded = load_from(&folder(&[("rover.proto", &schema), ("t.yaml", topology)]), "t.yaml");
        let problem = loaded.diagnostics.iter().find(|problem| problem.code() == "SCL0417").unwrap();
        problem.shown_helps().map(|help| help.text().into_owned()).collect::<String>()
    };
    let remove = "remove `rover.FIX`, which nothing uses, or rename it";
    assert_eq!(helps("message Fix { int32 a = 1; } message FIX { int32 a = 1; }"), remove);
    assert_eq!(helps("message FIX { int32 a = 1; } message Fix { int32 a = 1; }"), remove);
    assert_eq!(helps("message FIX {} message Fix {} message A { FIX fix = 1; }"), "rename one of them");
}

#[test]
fn types_that_become_one_are_refused() {
    let groups: [&[&str]; 7] = [
        // What is inside of them clashes as a consequence.
        &["message GPSFix { optional int32 a = 1; } message GpsFix { optional int32 a = 1; message B {} }"],
        &["message Fix {} enum FIX { A = 0; }"],
        &["message Fix {}", "message FIX_ {}"],
        &["message A { oneof fix { int32 a = 1; } oneof FIX { int32 b = 2; } }"],
        &["message A { message Fix {} oneof fix { int32 a = 1; } message FixOneOf {} }"],
        &["// no package\nmessage Sensor {}"],
        &["// no package\nenum sensor_peer { A = 0; }"],
    ];
    refused(
        &groups,
        expect![[r#"
        message `rover.GPSFix` and message `rover.GpsFix` would both become `GpsFix` in the Rust module `rover`
        message `rover.Fix` and enum `rover.FIX` would both become `Fix` in the Rust module `rover`
        message `rover.Fix` and message `rover.FIX_` would both become `Fix` in the Rust module `rover`
        oneof `rover.A.fix` and oneof `rover.A.FIX` would both become `fix` in the Rust struct `rover::A`
        message `rover.A.FixOneOf` and oneof `rover.A.fix` would both become `FixOneOf` in the Rust module `rover::a`
        component `sensor` and message `Sensor` would both become `Sensor` in the module that calls the macro
        the counterpart of component `sensor` and enum `sensor_peer` would both become `SensorPeer` in the module that calls the macro
    "#]],
    );
}

#[test]
fn modules_that_become_one_are_refused() {
    let groups: [&[&str]; 3] = [
        &["message Status { oneof kind { int32 a = 1; } }", "package rover.status; message B {}"],
        &["message Status { enum Kind { A = 0; } } message STATUS_ { message B {} }"],
        &["message _1 { message B {} }"],
    ];
    refused(
        &groups,
        expect![[r#"
        the module of message `rover.Status` and package `rover.status` would both become `status` in the Rust module `rover`
        message `rover.Status` and message `rover.STATUS_` would both become `Status` in the Rust module `rover`
        message `rover._1` and the module of message `rover._1` would both become `_1` in the Rust module `rover`
    "#]],
    );
}

#[test]
fn members_that_become_one_are_refused() {
    let groups: [&[&str]; 6] = [
        &["enum Mode { MODE_AUTO = 0; AUTO = 1; }"],
        &["enum Gps { GPS_1 = 0; GPS1 = 1; }"],
        &["message A { oneof kind { int32 a = 1; int32 A = 2; } }"],
        &["enum E { X = 0; } message A { optional E m = 1; optional int32 set_m = 2; }"],
        &["enum E { X = 0; } message A { repeated E m = 1; optional int32 push_m = 2; }"],
        &["enum E { X = 0; } message A { map<int32, E> m = 1; optional int32 get_m = 2; }"],
    ];
    refused(
        &groups,
        expect![[r#"
            enum value `rover.MODE_AUTO` and enum value `rover.AUTO` would both become `Auto` in the Rust enum `rover::Mode`
            enum value `rover.GPS_1` and enum value `rover.GPS1` would both become `Gps1` in the Rust enum `rover::Gps`
            field `rover.A.a` and field `rover.A.A` would both become `A` in the Rust enum `rover::a::Kind`
            field `rover.A.m` and field `rover.A.set_m` would both become `set_m` among the methods of the Rust struct `rover::A`
            field `rover.A.m` and field `rover.A.push_m` would both become `push_m` among the methods of the Rust struct `rover::A`
            field `rover.A.m` and field `rover.A.get_m` would both become `get_m` among the methods of the Rust struct `rover::A`
        "#]],
    );
}

#[test]
fn names_without_a_letter_are_refused() {
    let groups: [&[&str]; 5] = [
        &["message __ {}"],
        &["enum E { _ = 0; }"],
        &["message A { oneof _ { int32 a = 1; } }"],
        &["package rover._; message A {}"],
        &["enum E { X = 0; } message A { map<int32, E> type = 1; }"],
    ];
    refused(
        &groups,
        expect![[r#"
        message `rover.__` has no name in Rust, because it has neither letters nor digits
        enum value `rover._` has no name in Rust, because it has neither letters nor digits
        oneof `rover.A._` has no name in Rust, because it has neither letters nor digits
        package `rover._` has no name in Rust, because it has neither letters nor digits
        field `rover.A.type` would get the method `get_r#type`, which is not a name in Rust
    "#]],
    );
}

#[test]
fn what_rust_can_write_is_accepted() {
    let sound: [&[&str]; 10] = [
        &["message Self {} message Type { oneof self { int32 crate = 1; int32 super = 2; } }"],
        &["package rover.crate.self.super.extern.gen.type; message A {}"],
        &["package rover.Nav; message A {}", "package rover.nav; message B {}"],
        &["message Bool { enum E { X = 0; } } message A { optional bool a = 1; optional Bool b = 2; }"],
        &["message Fix {} message A { message Fix {} oneof fix { int32 a = 1; } }"],
        &["enum Mode { option allow_alias = true; MODE_AUTO = 0; AUTO = 0; }"],
        &["enum Gps { GPS_1 = 0; GPS_2 = 1; }"],
        &["message Status { optional int32 a = 1; }", "package rover.status; message B {}"],
        &["message A { map<int32, int32> m = 1; optional int32 get_m = 2; optional string set_m = 3; }"],
        &["enum E { X = 0; } message A { map<int32, E> kind = 1; optional E type = 2; }"],
    ];
    for schemas in sound {
        assert_eq!(told(schemas), [], "{schemas:?}");
    }
}

#[test]
fn a_package_that_hides_a_crate_is_a_warning() {
    let told = told(&["package std.error; message A {}", "package std.other; message B {}", "package rover.log;"]);
    let [(code, message)] = told.as_slice() else { panic!("{told:?}") };
    assert_eq!(*code, "SCL0418");
    let expected =
        "the package `std.error` becomes the Rust module `std`, which hides the crate `std` where the macro is called";
    assert_eq!(message, expected);
}
