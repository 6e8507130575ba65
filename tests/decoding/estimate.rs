//! The estimate of a frame beside what decoding it really allocates.

use crate::decoding::{Leaf, Tree, tree};
use crate::{Taker, counted, turn};
use scl::Component;
use scl::bytes::{Bytes, BytesMut};
use scl::codec::{Codec, Json, Protobuf};
use scl_shape::{Format, Language, MemoryEstimate};

fn estimate(format: Format) -> MemoryEstimate {
    let files = scl_shape::decode(Taker::SPEC.schema.expect("a schema").descriptors).expect("descriptors");
    MemoryEstimate::new(&files, "decoding.Tree", Language::Rust, format).expect("a declared message")
}

/// Frames of protobuf that take much memory.
fn frames() -> Vec<(&'static str, Vec<u8>)> {
    let many = |part: &[u8]| part.repeat(20_000);
    let nested = (0..90).fold(many(b"\x0a\0"), |inner, _| tagged(0x0a, &inner));
    let boxed = (0..90).fold(Vec::new(), |inner, _| tagged(0x2a, &inner));
    let mut entries = Vec::new();
    let mut named = Vec::new();
    for number in 0..20_000_u32 {
        entries.extend(tagged(0x3a, &[&b"\x08"[..], &varint(number)].concat()));
        named.extend(tagged(0x32, &tagged(0x0a, number.to_string().as_bytes())));
    }
    let mixed = Tree {
        text: "a text".into(),
        leaves: vec![Leaf { x: 1.0 }; 10],
        by_name: [("a".to_owned(), Leaf { x: 2.0 })].into(),
        choice: Some(tree::Choice::AsText("b".into())),
        ..Tree::default()
    };
    vec![
        ("nothing", Vec::new()),
        ("empty children", many(b"\x0a\0")),
        ("children with one child each", many(b"\x0a\x02\x0a\0")),
        ("children with an only child in an only child", many(b"\x0a\x06\x0a\x04\x0a\x02\x0a\0")),
        ("children at the end of a chain", nested),
        ("boxes in boxes", tagged(0x0a, &boxed).repeat(500)),
        ("packed numbers of one byte", tagged(0x12, &[1; 20_000])),
        ("numbers that are not packed", many(b"\x10\x01")),
        ("packed flags", tagged(0x4a, &[1; 20_000])),
        ("one packed number in each of many fields", many(b"\x12\x01\x01")),
        ("empty texts", many(b"\x42\0")),
        ("texts of one byte", many(b"\x42\x01a")),
        ("empty blobs", many(b"\x82\x01\0")),
        ("empty leaves", many(b"\x52\0")),
        ("entries with children", entries),
        ("entries with names", named),
        ("children with an empty entry", many(b"\x0a\x02\x3a\0")),
        ("children with an empty leaf in place", many(b"\x0a\x02\x22\0")),
        ("fields in turns", many(b"\x0a\0\x52\0\x42\0")),
        ("empty values of any type", tagged(0x72, &many(b"\x0a\0"))),
        ("lists in lists of any type", tagged(0x72, &many(b"\x0a\x02\x32\0"))),
        ("an object with empty entries, of which one remains", tagged(0x8a01, &many(b"\x0a\0"))),
        ("unknown fields", many(b"\xa2\x06\x01a\xa0\x06\x01")),
        ("a message as programs send it", Protobuf::to_frame(&mixed, &mut BytesMut::new()).expect("encoded").to_vec()),
    ]
}

fn tagged(key: u16, content: &[u8]) -> Vec<u8> {
    let mut field = if key > 0xff { key.to_be_bytes().to_vec() } else { vec![key as u8] };
    field.extend(varint(content.len() as u32));
    field.extend(content);
    field
}

fn varint(mut number: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
    bytes
}

fn texts() -> Vec<(&'static str, Vec<u8>)> {
    let list = |name: &str, item: &str| format!(r#"{{"{name}":[{}]}}"#, vec![item; 20_000].join(","));
    let object = |name: &str, value: &str| {
        let entries: Vec<String> = (0..20_000).map(|number| format!(r#""{number}":{value}"#)).collect();
        format!(r#"{{"{name}":{{{}}}}}"#, entries.join(","))
    };
    let texts = vec![
        ("nothing", "{}".to_owned()),
        ("empty children", list("children", "{}")),
        ("children with a field", list("children", r#"{"maybe":1}"#)),
        ("children with an only child", list("children", r#"{"children":[{}]}"#)),
        ("children with two fields", list("children", r#"{"maybe":1,"boxed":{}}"#)),
        ("numbers", list("numbers", "1")),
        ("flags", list("flags", "true")),
        ("empty texts", list("texts", r#""""#)),
        ("leaves", list("leaves", r#"{"x":1}"#)),
        ("durations", list("times", r#""1s""#)),
        ("numbers of any type", list("anyList", "0").replace('[', "[[").replace(']', "]]")),
        ("lists in a list of any type", list("anyList", "[]")),
        ("objects in a list of any type", list("anyList", r#"{"":0}"#)),
        ("an object of any type", object("anyObject", "0")),
        ("entries with names", object("byName", "{}")),
        ("entries with children", object("byNumber", r#"{"maybe":1}"#)),
        ("children with entries", list("children", r#"{"byName":{"":{}}}"#)),
        ("unknown fields", list("added", r#"{"a":[1,{}]}"#)),
        ("a long text", format!(r#"{{"text":"{}"}}"#, "a".repeat(50_000))),
        ("escapes", format!(r#"{{"text":"{}"}}"#, "\\u0000".repeat(10_000))),
    ];
    texts.into_iter().map(|(case, text)| (case, text.into_bytes())).collect()
}

#[test]
fn decoding_protobuf_allocates_no_more_than_estimated() {
    let _turn = turn();
    compare::<Protobuf>(&estimate(Format::Protobuf), frames());
}

#[test]
fn decoding_json_allocates_no_more_than_estimated() {
    let _turn = turn();
    // The described types are made once.
    <Json as Codec<Tree>>::decode(Bytes::from_static(b"{}")).expect("a message");
    compare::<Json>(&estimate(Format::Json), texts());
}

fn compare<C: Codec<Tree>>(estimate: &MemoryEstimate, frames: Vec<(&str, Vec<u8>)>) {
    let mut wrong = Vec::new();
    for (case, frame) in frames {
        let length = frame.len() as u64;
        let frame = Bytes::from(frame);
        let estimated = estimate.of(&frame).expect("JSON");
        let (decoded, allocated) = counted(|| C::decode(frame));
        println!("{case}: {length} bytes, allocated {allocated}, estimated {estimated}");
        assert!(decoded.is_ok(), "{case}: {decoded:?}");
        // The message itself is returned on the stack.
        let real = allocated + size_of::<Tree>() as u64;
        let most =
            estimate.most_per_byte() * length + estimate.of(if C::NAME == "json" { b"{}" } else { b"" }).expect("JSON");
        // Far too much would refuse messages that programs send.
        let far = length > 1000 && !case.ends_with("one remains") && estimated > 8 * real + 10 * length;
        if estimated < real || estimated > most || far {
            wrong.push(format!("{case}: {length} bytes took {real}, estimated {estimated}, at most {most}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
