//! The modules that messages of `schemas:` use in place of `prost`, so that the sign of -0.0 is sent.
//!
//! prost leaves out a field that equals its default, and -0.0 equals 0.0. Protobuf leaves out only fields that have the
//! bits of 0.0 (<https://protobuf.dev/programming-guides/proto3/#default>), as the libraries of other languages do. The
//! macro makes such fields `required`, which prost always passes to `encode`; the `encode` of these modules decides.

/// For messages in which 0.0 is left out. They have no `optional` or `required` floats, which would be encoded by the
/// same functions.
pub mod without_zeros {
    pub use prost::*;

    pub mod encoding {
        pub use super::super::hash_map;
        pub use prost::encoding::*;

        /// Defines the functions for one type of floats.
        macro_rules! floats {
            ($module:ident $float:ty) => {
                pub mod $module {
                    pub use prost::encoding::$module::*;

                    pub fn encode(tag: u32, value: &$float, buffer: &mut impl prost::bytes::BufMut) {
                        if value.to_bits() != 0 {
                            prost::encoding::$module::encode(tag, value, buffer);
                        }
                    }

                    pub fn encoded_len(tag: u32, value: &$float) -> usize {
                        if value.to_bits() != 0 { prost::encoding::$module::encoded_len(tag, value) } else { 0 }
                    }
                }
            };
        }

        floats!(double f64);
        floats!(float f32);
    }
}

/// For messages in which 0.0 is sent, too, which means the same to a receiver.
pub mod with_zeros {
    pub use prost::*;

    pub mod encoding {
        pub use super::super::hash_map;
        pub use prost::encoding::*;
    }
}

/// Maps, of which both key and value are always sent, as in C++ and Python.
pub mod hash_map {
    use prost::bytes::BufMut;
    pub use prost::encoding::hash_map::*;
    use prost::encoding::{WireType, encode_key, encode_varint, encoded_len_varint, key_len};
    use std::collections::HashMap;

    pub fn encode<K, V, B: BufMut>(
        encode_entry_key: impl Fn(u32, &K, &mut B),
        key_length: impl Fn(u32, &K) -> usize,
        encode_entry_value: impl Fn(u32, &V, &mut B),
        value_length: impl Fn(u32, &V) -> usize,
        tag: u32,
        map: &HashMap<K, V>,
        buffer: &mut B,
    ) {
        for (key, value) in map {
            encode_key(tag, WireType::LengthDelimited, buffer);
            encode_varint((key_length(1, key) + value_length(2, value)) as u64, buffer);
            encode_entry_key(1, key, buffer);
            encode_entry_value(2, value, buffer);
        }
    }

    pub fn encoded_len<K, V>(
        key_length: impl Fn(u32, &K) -> usize,
        value_length: impl Fn(u32, &V) -> usize,
        tag: u32,
        map: &HashMap<K, V>,
    ) -> usize {
        let entries = map.iter().map(|(key, value)| {
            let length = key_length(1, key) + value_length(2, value);
            key_len(tag) + encoded_len_varint(length as u64) + length
        });
        entries.sum()
    }
}
