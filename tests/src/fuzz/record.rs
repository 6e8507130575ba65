//! Messages with a bit of everything: what nests, what has a length, what may be absent.

use scl::bytes::Bytes;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// For the codecs of serde types.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Record {
    name: String,
    on: bool,
    letter: char,
    narrow: (i8, u16, i32),
    wide: [u64; 2],
    exact: f64,
    rough: f32,
    unit: (),
    signs: Vec<u8>,
    lists: Vec<Vec<Option<i64>>>,
    children: Vec<Record>,
    by_name: BTreeMap<String, Record>,
    by_number: BTreeMap<i16, Shape>,
    shape: Shape,
    below: Option<Box<Record>>,
}

/// For the same, and nothing but nesting.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) enum Shape {
    #[default]
    Nothing,
    Length(f64),
    Sides(u8, i64),
    Named {
        text: String,
        of: Box<Shape>,
    },
    Many(Vec<Shape>),
    Perhaps(Option<Box<Shape>>),
}

/// For protobuf.
#[derive(Clone, PartialEq, prost::Message)]
pub(super) struct Proto {
    #[prost(string, tag = "1")]
    name: String,
    #[prost(bytes = "bytes", tag = "2")]
    shared: Bytes,
    #[prost(sint64, optional, tag = "3")]
    perhaps: Option<i64>,
    #[prost(double, repeated, tag = "4")]
    values: Vec<f64>,
    #[prost(uint32, repeated, packed = "false", tag = "5")]
    loose: Vec<u32>,
    #[prost(message, repeated, tag = "6")]
    children: Vec<Proto>,
    #[prost(btree_map = "string, message", tag = "7")]
    by_name: BTreeMap<String, Proto>,
    #[prost(enumeration = "Kind", tag = "8")]
    kind: i32,
    #[prost(oneof = "Either", tags = "9, 10, 11")]
    either: Option<Either>,
    #[prost(fixed32, tag = "12")]
    fixed: u32,
    #[prost(float, tag = "13")]
    rough: f32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, prost::Enumeration)]
#[repr(i32)]
enum Kind {
    Silent = 0,
    Loud = 7,
}

#[derive(Clone, PartialEq, prost::Oneof)]
enum Either {
    #[prost(bool, tag = "9")]
    Flag(bool),
    #[prost(message, tag = "10")]
    Below(Box<Proto>),
    #[prost(bytes = "vec", tag = "11")]
    Owned(Vec<u8>),
}

/// For memory as it is.
#[derive(Debug, Default, IntoBytes, FromBytes, KnownLayout, Immutable)]
#[repr(C)]
pub(super) struct Flat {
    stamp: u64,
    axes: [f32; 3],
    flags: [u8; 4],
}

/// One that has something in each field.
pub(super) fn full_record() -> Record {
    let below = Record { wide: [u64::MAX, 1], ..Record::default() };
    Record {
        name: "imu \u{1F600}\"\n".into(),
        on: true,
        letter: 'ß',
        narrow: (-128, 65535, -70_000),
        exact: 0.1 + 0.2,
        rough: 1e-7,
        signs: vec![0, 127, 255],
        lists: vec![vec![], vec![Some(-1), None, Some(i64::MAX)]],
        children: vec![Record::default(), Record { name: "child".into(), ..Record::default() }],
        by_name: BTreeMap::from([("a".into(), Record::default())]),
        by_number: BTreeMap::from([(-7, Shape::Nothing), (300, full_shape())]),
        shape: Shape::Perhaps(None),
        below: Some(Box::new(below)),
        ..Record::default()
    }
}

/// One of each variant.
pub(super) fn full_shape() -> Shape {
    let named = Shape::Named { text: "läuft".into(), of: Box::new(Shape::Length(-0.1)) };
    let perhaps = Shape::Perhaps(Some(Box::new(Shape::Sides(255, i64::MIN))));
    Shape::Many(vec![Shape::Nothing, Shape::Length(1e300), named, Shape::Many(vec![]), perhaps])
}

/// One that has something in each field.
pub(super) fn full_proto() -> Proto {
    let either = |either| Proto { either: Some(either), ..Proto::default() };
    Proto {
        name: "läuft".into(),
        shared: Bytes::from_static(b"\0\xff"),
        perhaps: Some(-3),
        values: vec![0.5, f64::INFINITY],
        loose: vec![1, u32::MAX],
        children: vec![Proto::default(), either(Either::Flag(true)), either(Either::Owned(vec![1; 20]))],
        by_name: BTreeMap::from([("a".into(), Proto::default())]),
        kind: Kind::Loud.into(),
        either: Some(Either::Below(Box::default())),
        fixed: 9,
        rough: -1.5,
    }
}
