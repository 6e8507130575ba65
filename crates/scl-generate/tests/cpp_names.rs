//! Names in generated C++: types of messages, headers, namespaces, and what protoc declares beside the components.

use crate::fixture::{clashes, generated, system, text, topology};
use expect_test::expect_file;
use scl_generate::{System, Target, generate};
use scl_loader::{Request, load};

/// The generated header of a topology with these gates and this schema, without the plan.
fn header(gates: &str, schema: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (path, proto) = (folder.path().join("new.yaml"), folder.path().join("part"));
    std::fs::create_dir(&proto).unwrap();
    std::fs::write(proto.join("messages.proto"), schema).unwrap();
    let peers: String =
        gates.lines().map(|gate| gate.replace("pub", "sub").replace("req", "rep")).map(|gate| gate + "\n").collect();
    let names: Vec<&str> = gates.lines().filter_map(|gate| gate.trim().strip_prefix("- ")?.split(':').next()).collect();
    let connections: String = names.iter().map(|name| format!("  - [one.{name}, two.{name}]\n")).collect();
    let text = format!(
        "schemas: [part/messages.proto]\ncomponents:\n  - name: one\n    gates:\n{gates}\n  - name: two\n    gates:\n{peers}\
         connections:\n{connections}"
    );
    std::fs::write(&path, text).unwrap();
    let loaded = load(&Request::new(&path));
    let system = System::of(&loaded).unwrap_or_else(|| panic!("{:#?}", loaded.diagnostics));
    generate(&system, Target::Cpp).unwrap().remove(0).text
}

#[test]
fn every_kind_of_gate_is_a_member() {
    let files = generated(&topology("every_kind.yaml"), Target::Cpp);
    expect_file!["expected/every_kind.scl.hpp"].assert_eq(&text(&files, "every_kind.scl.hpp"));
}

#[test]
fn messages_have_the_names_that_protoc_gives_them() {
    let schema = "syntax = \"proto3\"; package a.b; message Outer { message Inner {} } message class {}";
    let gates = "      - outer: {pub: a.b.Outer}\n      - inner: {pub: a.b.Outer.Inner}\n      - word: {pub: a.b.class}\n      \
                 - ask: {req: a.b.Outer -> a.b.class}\n      - text: {pub: a.b.Outer, codec: json}";
    let text = header(gates, schema);
    for line in [
        "#include \"part/messages.pb.h\"\n\nnamespace new_ {",
        "#include <scl.hpp>\n#include <scl/json.hpp>\n#include <scl/protobuf.hpp>\n",
        "::scl::Pub<::a::b::Outer> outer{*this, \"outer\"};",
        "::scl::Sub<::a::b::Outer_Inner> inner{*this, \"inner\"};",
        "::scl::Pub<::a::b::class_> word{*this, \"word\"};",
        "::scl::Rep<::a::b::Outer, ::a::b::class_> ask{*this, \"ask\"};",
        "::scl::Sub<::a::b::Outer, ::scl::Json> text{*this, \"text\"};",
    ] {
        assert!(text.contains(line), "{line}\nis not in\n{text}");
    }
}

#[test]
fn messages_without_a_package_are_global() {
    let text = header("      - value: {pub: Number}", "syntax = \"proto3\"; message Number {}");
    assert!(text.contains("::scl::Pub<::Number> value{*this, \"value\"};"), "{text}");
}

/// Without gates that carry protobuf messages, a program needs no libprotobuf.
#[test]
fn a_system_of_bytes_includes_nothing_of_protobuf() {
    let text = generate(&system(&topology("bytes.yaml")), Target::Cpp).unwrap().remove(0).text;
    assert!(!text.contains("protobuf.hpp") && !text.contains(".pb.h") && text.contains("<::scl::Bytes>"), "{text}");
}

#[test]
fn all_that_protoc_declares_beside_components_may_clash() {
    let yaml = "\
system: rover
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - values: {pub: rover.Measurement}
  - name: sink
    gates:
      - values: {sub: rover.Measurement}
connections:
  - [sensor.values, sink.values]
";
    let used = "message Measurement {}";
    let cases = [
        ("package rover; message Sensor {}", Some("message `rover.Sensor`")),
        ("package rover; enum Sensor { A = 0; }", Some("enum `rover.Sensor`")),
        ("package rover; enum Kind { Sensor = 0; }", Some("enum value `rover.Sensor`")),
        ("package rover; message sensor {} message Sensors { message Sensor {} }", None),
    ];
    for (schema, expected) in cases {
        let told = clashes(yaml, &format!("syntax = \"proto3\"; {schema} {used}"), Target::Cpp);
        match expected {
            None => assert_eq!(told, "", "{schema}"),
            Some(what) => {
                let line =
                    format!("{what} and component `sensor` would both become `Sensor` in the C++ namespace `rover`");
                assert!(told.contains(&line), "{schema}: {told}");
            }
        }
    }
}

#[test]
fn the_namespace_of_the_system_is_no_message() {
    let yaml = "\
system: rover
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - values: {pub: rover}
  - name: sink
    gates:
      - values: {sub: rover}
connections:
  - [sensor.values, sink.values]
";
    let told = clashes(yaml, "syntax = \"proto3\"; message rover {}", Target::Cpp);
    assert!(told.contains("message `rover` would both become `rover` in the global C++ namespace"), "{told}");
}

/// The verdict on a topology with a gate of this message, whose schema has this package and this declaration.
fn verdict(message: &str, schema: &str) -> String {
    let yaml = format!(
        "system: rover\nschemas: [rover.proto]\nconnections: []\ncomponents:\n  - name: sensor\n    gates:\n      \
         - values: {{pub: {message}, unconnected: ok}}\n"
    );
    let told = clashes(&yaml, &format!("syntax = \"proto3\"; {schema}"), Target::Cpp);
    told.lines().next().unwrap_or_default().to_owned()
}

#[test]
fn names_that_protoc_does_not_escape_are_refused() {
    for package in ["export", "rover.class.v1", "a.NULL", "concept"] {
        let part = package.split('.').find(|part| !["rover", "a"].contains(part)).unwrap();
        let expected = format!(
            "error: [SCL1103] `{part}` in the package of `{package}.Fix` is reserved in C++, and protoc does not escape \
             it there"
        );
        assert_eq!(verdict(&format!("{package}.Fix"), &format!("package {package}; message Fix {{}}")), expected);
    }
    for word in ["concept", "requires", "co_await", "char8_t"] {
        let expected = format!(
            "error: [SCL1103] the message `rover.{word}` is `{word}` in C++ with some versions of protoc, and `{word}_` \
             with others"
        );
        assert_eq!(verdict(&format!("rover.{word}"), &format!("package rover; message {word} {{}}")), expected);
    }
    assert_eq!(verdict("rover.Fix", "package rover; message Fix {} message concept {}"), "");
    assert_eq!(verdict("rover.Fix.concept", "package rover; message Fix { message concept {} }"), "");
}

#[test]
fn names_are_escaped_as_by_protoc() {
    for (word, expected) in [("NULL", "NULL_"), ("class", "class_"), ("linux", "linux"), ("restrict", "restrict")] {
        let gates = format!("      - word: {{pub: rover.{word}}}");
        let text = header(&gates, &format!("syntax = \"proto3\"; package rover; message {word} {{}}"));
        let line = format!("::scl::Pub<::rover::{expected}> word{{");
        assert!(text.contains(&line), "{line} is not in\n{text}");
    }
}
