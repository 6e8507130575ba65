//! Which changes of messages are compatible.

use super::*;
use prost::Message;
use prost_types::{EnumValueDescriptorProto, MessageOptions, OneofDescriptorProto};

/// Messages of a package `nav`, one a line: `Position: 1 lat double; 2 lon double`, `enum Mode: 0 OFF; 1 ON`.
///
/// The words of a field are its number, name and type, or `repeated` or `optional` and its type, or its type and
/// `oneof` and a name. Types that start with a dot are messages, with `enum.` enums.
fn schema(text: &str) -> FileDescriptorSet {
    let mut file = prost_types::FileDescriptorProto { package: Some("nav".to_owned()), ..Default::default() };
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (name, items) = line.split_once(':').unwrap();
        let items: Vec<Vec<&str>> = items.split(';').map(|item| item.split_whitespace().collect()).collect();
        let items = items.into_iter().filter(|item: &Vec<&str>| !item.is_empty());
        match name.strip_prefix("enum ") {
            Some(name) => file.enum_type.push(enumeration(name, items)),
            None => add(&mut file.message_type, name, message(name.rsplit('.').next().unwrap(), items)),
        }
    }
    FileDescriptorSet { file: vec![file] }
}

/// Adds a message, inside of another if its name has dots.
fn add(messages: &mut Vec<DescriptorProto>, name: &str, message: DescriptorProto) {
    match name.split_once('.') {
        None => messages.push(message),
        Some((outer, rest)) => {
            let outer = messages.iter_mut().find(|found| found.name() == outer).unwrap();
            add(&mut outer.nested_type, rest, message);
        }
    }
}

fn enumeration<'t>(name: &str, items: impl Iterator<Item = Vec<&'t str>>) -> EnumDescriptorProto {
    let value = |item: Vec<&str>| EnumValueDescriptorProto {
        number: Some(item[0].parse().unwrap()),
        name: Some(item[1].to_owned()),
        ..Default::default()
    };
    EnumDescriptorProto { name: Some(name.to_owned()), value: items.map(value).collect(), ..Default::default() }
}

fn message<'t>(name: &str, items: impl Iterator<Item = Vec<&'t str>>) -> DescriptorProto {
    let mut message = DescriptorProto { name: Some(name.to_owned()), ..Default::default() };
    for item in items {
        let mut field = FieldDescriptorProto {
            number: Some(item[0].parse().unwrap()),
            name: Some(item[1].to_owned()),
            label: Some(Label::Optional.into()),
            ..Default::default()
        };
        let kind = match item[2..] {
            ["repeated", kind] => {
                field.label = Some(Label::Repeated.into());
                kind
            }
            ["required", kind] => {
                field.label = Some(Label::Required.into());
                kind
            }
            ["optional", kind] => {
                (field.oneof_index, field.proto3_optional) =
                    (Some(oneof(&mut message, &format!("_{}", item[1]))), Some(true));
                kind
            }
            [kind, "oneof", name] => {
                field.oneof_index = Some(oneof(&mut message, name));
                kind
            }
            [kind] => kind,
            _ => panic!("{item:?}"),
        };
        let (kind, type_name) = match kind.strip_prefix("enum") {
            Some(name) => (Type::Enum, Some(name)),
            None if kind.starts_with('.') => (Type::Message, Some(kind)),
            None => (Type::from_str_name(&format!("TYPE_{}", kind.to_ascii_uppercase())).unwrap(), None),
        };
        (field.r#type, field.type_name) = (Some(kind.into()), type_name.map(str::to_owned));
        message.field.push(field);
    }
    if name.ends_with("Entry") {
        message.options = Some(MessageOptions { map_entry: Some(true), ..Default::default() });
    }
    message
}

fn oneof(message: &mut DescriptorProto, name: &str) -> i32 {
    let known = message.oneof_decl.iter().position(|oneof| oneof.name() == name);
    let index = known.unwrap_or_else(|| {
        message.oneof_decl.push(OneofDescriptorProto { name: Some(name.to_owned()), ..Default::default() });
        message.oneof_decl.len() - 1
    });
    index.try_into().unwrap()
}

fn check(here: &str, there: &str, expected: &str) {
    let found = compare("nav.A", Encoding::Numbers, &schema(here), &schema(there))
        .map_err(|difference| difference.text("`gps`"));
    assert_eq!(found.err().unwrap_or_default(), expected, "\nhere:\n{here}\nthere:\n{there}");
}

#[test]
fn compatible_changes_are_allowed_in_both_directions() {
    let cases = [
        ("A: 1 lat double; 2 lon double", "A: 2 lon double; 1 lat double"),
        ("A: 1 lat double", "A: 1 lat double; 2 lon double"),
        ("A: 1 lat double", "A: 2 lon double"),
        ("A: 1 lat double", "A:"),
        ("A: 1 lat double", "A: 1 lat optional double"),
        ("A: 1 lat double", "A: 1 lat required double"),
        ("A: 1 lat double", "A: 1 lat double; 2 a double oneof kind; 3 b double oneof kind"),
        ("A: 1 a double oneof kind", "A: 1 a double oneof kind; 2 b double oneof kind"),
        ("A: 1 mode enum.nav.M\nenum M: 0 OFF; 1 ON", "A: 1 mode enum.nav.M\nenum M: 0 OFF; 2 AUTO"),
        ("A: 1 mode enum.nav.M\nenum M: 0 OFF; 0 NONE", "A: 1 mode enum.nav.M\nenum M: 0 NONE"),
        ("A: 1 tags repeated .nav.A.TagsEntry\nA.TagsEntry: 1 key string; 2 value double", "A: 2 lat double"),
        // Incompatible, but the gate does not carry it.
        ("A: 1 lat double\nB: 1 x double", "A: 1 lat double\nB: 1 x string"),
        ("A: 1 lat double; 2 b .nav.B\nB: 1 x double", "A: 1 lat double\nB: 1 x string"),
        // Only one program knows it.
        ("A: 1 lat double", "B: 1 lat string"),
        ("A: 1 b .nav.B\nB: 1 x double", "A: 1 b .nav.B"),
    ];
    for (one, other) in cases {
        check(one, other, "");
        check(other, one, "");
    }
}

#[test]
fn incompatible_changes_name_both_sides() {
    let cases = [
        (
            "1 lat double; 2 lon double",
            "1 lon double; 2 lat double",
            "field 1 is `lat` (double) here, but `lon` (double)",
        ),
        ("1 lat double", "1 lat float", "field 1 is `lat` (double) here, but `lat` (float)"),
        ("1 lat int32", "1 lat sint32", "field 1 is `lat` (int32) here, but `lat` (sint32)"),
        ("1 lat double", "1 lat repeated double", "field 1 is `lat` (double) here, but `lat` (repeated double)"),
        ("1 lat double", "2 lat double", "field `lat` has number 1 here, but 2"),
        ("1 b .nav.B", "1 b .nav.C", "field 1 is `b` (nav.B) here, but `b` (nav.C)"),
        ("1 b .nav.B", "1 b bytes", "field 1 is `b` (nav.B) here, but `b` (bytes)"),
        ("1 m enum.nav.M", "1 m int32", "field 1 is `m` (enum nav.M) here, but `m` (int32)"),
        ("1 m enum.nav.M", "1 m .nav.M", "field 1 is `m` (enum nav.M) here, but `m` (nav.M)"),
        ("1 a double oneof kind", "1 a double", "field 1 is `a` (double in oneof `kind`) here, but `a` (double)"),
        (
            "1 a double oneof kind",
            "1 a optional double",
            "field 1 is `a` (double in oneof `kind`) here, but `a` (double)",
        ),
        (
            "1 a double oneof kind",
            "1 a double oneof choice",
            "field 1 is `a` (double in oneof `kind`) here, but `a` (double in oneof `choice`)",
        ),
    ];
    for (here, there, expected) in cases {
        check(&format!("A: {here}"), &format!("A: {there}"), &format!("message `nav.A`: {expected} in `gps`"));
    }
}

#[test]
fn maps_are_compared_by_key_and_value() {
    let map = |key: &str, value: &str| {
        format!("A: 1 tags repeated .nav.A.TagsEntry\nA.TagsEntry: 1 key {key}; 2 value {value}\nB: 1 x double")
    };
    let field = "message `nav.A`: field 1 is `tags` ";
    check(&map("string", ".nav.B"), &map("string", ".nav.B"), "");
    check(
        &map("string", "double"),
        &map("string", ".nav.B"),
        &format!("{field}(map<string, double>) here, but `tags` (map<string, nav.B>) in `gps`"),
    );
    check(
        &map("string", "double"),
        &map("int32", "double"),
        &format!("{field}(map<string, double>) here, but `tags` (map<int32, double>) in `gps`"),
    );
    check(
        &map("string", "double"),
        "A: 1 tags repeated .nav.B\nB: 1 x double",
        &format!("{field}(map<string, double>) here, but `tags` (repeated nav.B) in `gps`"),
    );
    check(
        &map("string", ".nav.B"),
        &map("string", ".nav.B").replace("1 x double", "1 x bytes"),
        "message `nav.B`: field 1 is `x` (double) here, but `x` (bytes) in `gps`",
    );
}

#[test]
fn enums_are_compared_by_number_and_name() {
    let cases = [
        ("0 OFF; 1 ON", "0 OFF; 1 AUTO", "value 1 is `ON` here, but `AUTO`"),
        ("0 OFF; 1 ON", "0 ON; 1 OFF", "value 0 is `OFF` here, but `ON`"),
        ("0 OFF; 1 ON", "0 OFF; 2 ON", "value `ON` has number 1 here, but 2"),
        ("0 OFF; 0 NONE", "0 ZERO", "value 0 is `NONE` here, but `ZERO`"),
    ];
    for (here, there, expected) in cases {
        let text = |values: &str| format!("A: 1 mode enum.nav.M\nenum M: {values}");
        check(&text(here), &text(there), &format!("enum `nav.M`: {expected} in `gps`"));
    }
}

#[test]
fn messages_inside_of_messages_are_compared_and_cycles_end() {
    let nested = |kind: &str| {
        format!("A: 1 b .nav.B; 2 inner .nav.A.Inner\nA.Inner: 1 b .nav.B\nB: 1 a .nav.A; 2 b .nav.B; 3 deep {kind}")
    };
    check(&nested("double"), &nested("double"), "");
    let expected = "message `nav.B`: field 3 is `deep` (double) here, but `deep` (fixed64) in `gps`";
    check(&nested("double"), &nested("fixed64"), expected);
    let inner = |kind: &str| format!("A: 1 inner .nav.A.Inner\nA.Inner: 1 x {kind}");
    let expected = "message `nav.A.Inner`: field 1 is `x` (bool) here, but `x` (uint32) in `gps`";
    check(&inner("bool"), &inner("uint32"), expected);
}

#[test]
fn both_messages_of_a_call_are_compared() {
    let (here, there) = (schema("Q: 1 x double\nR: 1 y double"), schema("Q: 1 x double\nR: 1 y float"));
    assert!(compare("nav.Q -> nav.R", Encoding::Numbers, &here, &there).is_err());
    assert!(compare("nav.R -> nav.Q", Encoding::Numbers, &here, &there).is_err());
    assert!(compare("nav.Q -> nav.Q", Encoding::Numbers, &here, &there).is_ok());
    assert!(compare("bytes", Encoding::Numbers, &here, &there).is_ok());
}

#[test]
fn a_package_may_have_the_name_of_a_message() {
    let mut here = schema("A: 1 x double");
    let mut outer = schema("nav:\nnav.A: 1 x double").file.remove(0);
    outer.package = None;
    here.file.push(outer);
    let index = Index::of(&here);
    assert!(matches!(index.find("nav.A"), Some(Item::Message(found)) if found.field[0].name() == "x"));
    assert!(matches!(index.find("nav"), Some(Item::Message(_))));
    assert!(index.find("nav.B").is_none() && index.find("").is_none() && index.find("A").is_none());
}

#[test]
fn damaged_descriptors_are_compared_without_a_panic() {
    let here = schema(
        "A: 1 lat double; 2 b .nav.B; 3 tags repeated .nav.A.TagsEntry; 4 m enum.nav.M; 5 a bool oneof kind\n\
         A.TagsEntry: 1 key string; 2 value .nav.B\nB: 1 a .nav.A; 2 x optional bool\nenum M: 0 OFF; 1 ON",
    );
    let sound = here.encode_to_vec();
    let mut compared = 0;
    for (place, bit) in (0..sound.len()).flat_map(|place| (0..8).map(move |bit| (place, bit))) {
        let mut bytes = sound.clone();
        bytes[place] ^= 1 << bit;
        if let Ok(there) = FileDescriptorSet::decode(&*bytes) {
            compared += 1;
            let _any = (
                compare("nav.A", Encoding::Numbers, &here, &there),
                compare("nav.A", Encoding::Numbers, &there, &here),
            );
        }
    }
    assert!(compared > sound.len(), "{compared} of {}", sound.len() * 8);
}

#[test]
fn foreign_names_are_shortened_and_escaped() {
    let here = schema("A: 1 lat double");
    let cases = [("a\u{1b}[31mb".to_owned(), r"a\u{1b}[31mb".to_owned()), ("n".repeat(201), "n".repeat(200) + "…")];
    for (name, shown) in cases {
        let text = compare("nav.A", Encoding::Numbers, &here, &schema(&format!("A: 1 {name} double")))
            .unwrap_err()
            .text("`gps`");
        let expected = format!("message `nav.A`: field 1 is `lat` (double) here, but `{shown}` (double) in `gps`");
        assert_eq!(text, expected);
    }
}

/// In JSON numbers do not matter, and a name that only one program knows is a field that the other does not have.
#[test]
fn json_is_compared_by_names() {
    let found = |here: &str, there: &str| -> Vec<String> {
        let found = differences("nav.A", Encoding::Names, &schema(here), &schema(there));
        found.iter().map(|difference| difference.text("`gps`")).collect()
    };
    assert_eq!(found("A: 1 lat double; 2 lon double", "A: 1 lon double; 2 lat double"), [""; 0]);
    assert_eq!(found("A: 1 lat double", "A: 7 lat double; 8 lon double"), [""; 0]);
    let renamed = found("A: 1 lat double", "A: 1 latitude double");
    assert_eq!(renamed, ["message `nav.A`: field 1 is `lat` (double) here, but `latitude` (double) in `gps`"]);
    let another_type = found("A: 1 lat double", "A: 7 lat string");
    assert_eq!(another_type, ["message `nav.A`: field 1 is `lat` (double) here, but `lat` (string) in `gps`"]);
    let enums = |values: &str| format!("A: 1 m enum.nav.M\nenum M: {values}");
    assert_eq!(found(&enums("0 OFF; 1 ON"), &enums("0 ON; 1 OFF")), [""; 0]);
    assert_eq!(found(&enums("0 OFF"), &enums("0 NONE")), ["enum `nav.M`: value 0 is `OFF` here, but `NONE` in `gps`"]);
}

#[test]
fn every_difference_is_found_but_not_too_many() {
    let all = |here: &str, there: &str| differences("nav.A", Encoding::Numbers, &schema(here), &schema(there));
    let found = all("A: 1 a double; 2 b double; 3 c double", "A: 1 b double; 2 a double; 4 c double");
    let whats: Vec<What> = found.into_iter().map(|difference| difference.what).collect();
    assert_eq!(whats, [What::Field(1), What::Field(2), What::NumberOfField("c".to_owned())]);
    let many = |kind: &str| format!("A: {}", (1..500).map(|at| format!("{at} f{at} {kind};")).collect::<String>());
    assert_eq!(all(&many("double"), &many("float")).len(), MOST);
}
