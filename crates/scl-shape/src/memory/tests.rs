use super::*;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, MessageOptions};

fn field(number: i32, name: &str, kind: Type, label: Label, type_name: &str) -> FieldDescriptorProto {
    FieldDescriptorProto {
        number: Some(number),
        name: Some(name.to_owned()),
        json_name: Some(name.to_owned()),
        r#type: Some(kind.into()),
        label: Some(label.into()),
        type_name: Some(type_name.to_owned()),
        ..FieldDescriptorProto::default()
    }
}

fn message(name: &str, fields: &[FieldDescriptorProto]) -> DescriptorProto {
    DescriptorProto { name: Some(name.to_owned()), field: fields.to_vec(), ..DescriptorProto::default() }
}

/// `message Tree { repeated Tree c = 1; repeated int64 n = 2; string t = 3; Leaf l = 4; Tree b = 5; map<..> m = 6; repeated string s = 7; repeated Time w = 8; }`
fn files() -> FileDescriptorSet {
    let entry = message(
        "MEntry",
        &[
            field(1, "key", Type::String, Label::Optional, ""),
            field(2, "value", Type::Message, Label::Optional, ".t.Leaf"),
        ],
    );
    let options = Some(MessageOptions { map_entry: Some(true), ..MessageOptions::default() });
    let tree = DescriptorProto {
        nested_type: vec![DescriptorProto { options, ..entry }],
        ..message(
            "Tree",
            &[
                field(1, "c", Type::Message, Label::Repeated, ".t.Tree"),
                field(2, "n", Type::Int64, Label::Repeated, ""),
                field(3, "t", Type::String, Label::Optional, ""),
                field(4, "l", Type::Message, Label::Optional, ".t.Leaf"),
                field(5, "b", Type::Message, Label::Optional, ".t.Tree"),
                field(6, "m", Type::Message, Label::Repeated, ".t.Tree.MEntry"),
                field(7, "s", Type::String, Label::Repeated, ""),
                field(8, "w", Type::Message, Label::Repeated, ".google.protobuf.Value"),
            ],
        )
    };
    let leaf = message("Leaf", &[field(1, "x", Type::Double, Label::Optional, "")]);
    let value = message("Value", &[field(2, "number_value", Type::Double, Label::Optional, "")]);
    let file = |package: &str, messages| FileDescriptorProto {
        package: Some(package.to_owned()),
        message_type: messages,
        ..FileDescriptorProto::default()
    };
    FileDescriptorSet { file: vec![file("t", vec![tree, leaf]), file("google.protobuf", vec![value])] }
}

fn estimate(language: Language, format: Format) -> MemoryEstimate {
    MemoryEstimate::new(&files(), "t.Tree", language, format).unwrap()
}

/// What an estimate says of a frame besides the empty message, and that the bound for all frames holds.
#[track_caller]
fn added(language: Language, format: Format, frame: &[u8]) -> u64 {
    let estimate = estimate(language, format);
    let empty = estimate.messages[0].size;
    let total = estimate.of(frame).unwrap();
    assert!(total <= empty + estimate.most_per_byte() * frame.len() as u64, "{language:?} {frame:?}: {total}");
    total - empty
}

#[test]
fn what_two_bytes_can_announce_is_counted_at_every_depth() {
    for language in [Language::Rust, Language::Other] {
        let tree = estimate(language, Format::Protobuf).messages[0].size;
        let cases: [(&[u8], u64); 7] = [
            (b"\x0a\0\x0a\0", 2 * tree),
            (b"\x0a\x04\x0a\0\x0a\0", 3 * tree),
            (b"\x2a\x02\x2a\0", 2 * tree),
            (b"\x12\x05\x01\x02\x03\x04\x05", 5 * 8),
            (b"\x12\x03\xff\xff\x01", 8),
            (b"\x32\0\x32\0", 2 * 40),
            (b"\x3a\0\x3a\x02ab", 2 * 24 + 2),
        ];
        for (frame, least) in cases {
            let found = added(language, Format::Protobuf, frame);
            assert!(found >= least && found < 20 * least + 1000, "{language:?} {frame:?}: {found}, at least {least}");
        }
    }
    assert_eq!(added(Language::Rust, Format::Protobuf, b"\x22\0\x22\0"), 0, "in place");
    assert_eq!(added(Language::Rust, Format::Protobuf, b"\x78\x01\x7a\x02ab\x7b\x7c"), 0, "unknown, skipped");
    assert!(added(Language::Other, Format::Protobuf, b"\x78\x01\x7a\x02ab\x7b\x7c") > 100, "unknown, kept");
}

/// `protobuf-c` ignores the bits of a key beyond 32.
#[test]
fn a_key_of_too_many_bits_hides_nothing() {
    let (plain, long) = (b"\x0a\0".repeat(100), b"\x8a\x80\x80\x80\x10\0".repeat(100));
    let [plain, long] = [plain, long].map(|frame| added(Language::Other, Format::Protobuf, &frame));
    assert_eq!(plain, long);
}

#[test]
fn damaged_and_deep_frames_end() {
    for frame in [&b"\x0a"[..], b"\x0a\x05", b"\xff\xff", b"\x24\x24", b"\x0f", b"\x13", &[0xff; 30]] {
        assert!(added(Language::Rust, Format::Protobuf, frame) < 10_000, "{frame:?}");
    }
    for key in [b"\x0b", b"\x7b", b"\x2b"] {
        let deep = key.repeat(1_000_000);
        assert!(added(Language::Other, Format::Protobuf, &deep) < 1_000_000);
    }
}

#[test]
fn values_of_json_count_by_their_types() {
    let of = |text: &str| added(Language::Rust, Format::Json, text.as_bytes());
    let tree = estimate(Language::Rust, Format::Json).messages[0].size;
    assert!(of(r#"{"c":[{},{}]}"#) >= 2 * tree);
    assert!(of(r#"{"n":[0,0]}"#) >= 2 * 16);
    assert!(of(r#"{"w":[0,[0],{"a":0}]}"#) >= 5 * 1000);
    assert!(of(r#"{"m":{"":{},"":{}}}"#) >= 2 * 40);
    let unknown = br#"{"new":[[],[],{"a":[1,2]}]}"#;
    assert!(added(Language::Other, Format::Json, unknown) >= 6 * 100);
    assert_eq!(added(Language::Rust, Format::Json, unknown), 3 * (unknown.len() as u64));
    assert!(of(r#"{"n":[0,0]}"#) < of(r#"{"c":[{},{}]}"#), "numbers are not messages");
    assert!(estimate(Language::Other, Format::Json).of(b"{\"n\":NaN").is_err());
    assert!(estimate(Language::Other, Format::Json).of("[".repeat(1000).as_bytes()).is_err());
}

/// 64 levels of two fields each are 2^64 messages in place, and one pointer.
#[test]
fn sizes_do_not_overflow() {
    let level = |at: usize| {
        let inner = format!(".t.M{}", at + 1);
        let fields = [1, 2].map(|number| field(number, "f", Type::Message, Label::Optional, &inner));
        message(&format!("M{at}"), if at < 80 { &fields } else { &[] })
    };
    let file = FileDescriptorProto {
        package: Some("t".to_owned()),
        message_type: (0..=80).map(level).collect(),
        ..FileDescriptorProto::default()
    };
    let files = FileDescriptorSet { file: vec![file] };
    let of = |language| MemoryEstimate::new(&files, "t.M0", language, Format::Protobuf).unwrap().of(b"").unwrap();
    assert_eq!((of(Language::Rust), of(Language::Other)), (u64::MAX, 48));
    assert!(MemoryEstimate::new(&files, "t.Missing", Language::Rust, Format::Protobuf).is_none());
}
