//! The record that codecs encode and decode.

use serde::{Deserialize, Serialize};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// A message with typical values.
pub(super) trait Example {
    fn example() -> Self;
}

/// A fix of a satellite navigation receiver.
#[derive(Clone, PartialEq, prost::Message, Serialize, Deserialize)]
pub(super) struct Record {
    #[prost(bool, tag = "1")]
    valid: bool,
    #[prost(bool, tag = "2")]
    differential: bool,
    #[prost(uint32, tag = "3")]
    satellites: u32,
    #[prost(int64, tag = "4")]
    time: i64,
    #[prost(string, tag = "5")]
    receiver: String,
    #[prost(string, tag = "6")]
    mode: String,
    #[prost(double, tag = "7")]
    latitude: f64,
    #[prost(double, tag = "8")]
    longitude: f64,
    #[prost(float, tag = "9")]
    height: f32,
}

/// The same record with fields of fixed size, the widest first so that no padding is needed.
#[derive(Debug, Clone, Default, PartialEq, FromBytes, IntoBytes, KnownLayout, Immutable)]
#[repr(C)]
pub(super) struct FlatRecord {
    latitude: f64,
    longitude: f64,
    time: i64,
    height: f32,
    satellites: u32,
    receiver: [u8; 14],
    valid: u8,
    differential: u8,
    mode: [u8; 8],
}

impl Example for Record {
    fn example() -> Self {
        Self {
            valid: true,
            differential: false,
            satellites: 11,
            time: 1_357_034_096_123,
            receiver: "gps-left".to_owned(),
            mode: "3d".to_owned(),
            latitude: 50.682_51,
            longitude: 10.940_12,
            height: 478.25,
        }
    }
}

impl Example for FlatRecord {
    fn example() -> Self {
        let record = Record::example();
        let mut flat = Self {
            latitude: record.latitude,
            longitude: record.longitude,
            time: record.time,
            height: record.height,
            satellites: record.satellites,
            valid: record.valid.into(),
            differential: record.differential.into(),
            ..Self::default()
        };
        flat.receiver[..record.receiver.len()].copy_from_slice(record.receiver.as_bytes());
        flat.mode[..record.mode.len()].copy_from_slice(record.mode.as_bytes());
        flat
    }
}
