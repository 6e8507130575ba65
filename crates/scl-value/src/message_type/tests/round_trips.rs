//! Any message and any value come back as they were.

use super::*;
use proptest::prelude::*;
use prost::Message;
use prost_reflect::DynamicMessage;

/// The keys that YAML and protobuf have.
fn any_key() -> BoxedStrategy<Value> {
    prop_oneof![".{0,8}".prop_map(Value::Text), any::<i64>().prop_map(Value::Int), any::<bool>().prop_map(Value::Bool)]
        .boxed()
}

/// Any value that CBOR and MessagePack have.
fn any_value(key: BoxedStrategy<Value>) -> BoxedStrategy<Value> {
    let float = prop_oneof![any::<f64>(), any::<f32>().prop_map(crate::value::widen)];
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::Bool),
        any::<i64>().prop_map(Value::Int),
        any::<u64>().prop_map(Value::from),
        float.prop_filter("NaN differs from itself", |number| !number.is_nan()).prop_map(Value::Float),
        ".{0,8}".prop_map(Value::Text),
        prop::collection::vec(any::<u8>(), 0..8).prop_map(Value::Bytes),
    ];
    leaf.prop_recursive(4, 40, 6, move |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::List),
            prop::collection::vec((key.clone(), inner), 0..6).prop_map(Value::Map),
        ]
    })
    .boxed()
}

/// The bytes of a message of the schema, written by the library alone.
pub(super) fn any_message() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..200).prop_map(|seed| {
        let descriptor = descriptor("rover.Measurement");
        let mut message = DynamicMessage::new(descriptor.clone());
        for pair in seed.chunks_exact(9) {
            let Some(field) = descriptor.get_field(u32::from(pair[0]) % 28 + 1) else { continue };
            let bits = u64::from_le_bytes(pair[1..].try_into().unwrap());
            set_field(&mut message, &field, bits);
        }
        message.encode_to_vec()
    })
}

fn set_field(message: &mut DynamicMessage, field: &prost_reflect::FieldDescriptor, bits: u64) {
    use prost_reflect::{Kind, MapKey, Value as V};
    let scalar = |kind: &Kind| match kind {
        Kind::Double => V::F64(f64::from_bits(bits)),
        Kind::Float => V::F32(f32::from_bits(bits as u32)),
        Kind::Int32 | Kind::Sint32 | Kind::Sfixed32 => V::I32(bits as i32),
        Kind::Int64 | Kind::Sint64 | Kind::Sfixed64 => V::I64(bits as i64),
        Kind::Uint32 | Kind::Fixed32 => V::U32(bits as u32),
        Kind::Uint64 | Kind::Fixed64 => V::U64(bits),
        Kind::Bool => V::Bool(bits.is_multiple_of(2)),
        Kind::String => V::String(char::from_u32(bits as u32 % 0x500).map_or_else(String::new, String::from)),
        Kind::Bytes => V::Bytes(bits.to_le_bytes().to_vec().into()),
        Kind::Enum(_) => V::EnumNumber(bits as i32 % 4),
        Kind::Message(inner) => V::Message(DynamicMessage::new(inner.clone())),
    };
    let value = match field.kind() {
        Kind::Message(entry) if field.is_map() => {
            let key = match entry.map_entry_key_field().kind() {
                Kind::Bool => MapKey::Bool(bits.is_multiple_of(2)),
                Kind::Int32 => MapKey::I32(bits as i32),
                _ => MapKey::String(bits.to_string()),
            };
            V::Map([(key, scalar(&entry.map_entry_value_field().kind()))].into())
        }
        kind if field.is_list() => V::List(vec![scalar(&kind); bits as usize % 4]),
        kind => scalar(&kind),
    };
    message.set_field(field, value);
}

proptest! {
    #[test]
    fn protobuf_messages_come_back_as_they_were(bytes in any_message()) {
        let protobuf = message_type("rover.Measurement", "protobuf");
        let value = protobuf.decode(&bytes).unwrap();
        let again = protobuf.encode(&value).unwrap();
        // Not byte by byte: maps have no order, and a NaN has one text, whatever its bits.
        prop_assert_eq!((to_json(&protobuf.decode(&again).unwrap()), again.len()), (to_json(&value), bytes.len()));
        let from_text = protobuf.encode(&read_yaml(&to_yaml(&value)).unwrap()).unwrap();
        prop_assert_eq!(to_json(&protobuf.decode(&from_text).unwrap()), to_json(&value));
        let json = message_type("rover.Measurement", "json");
        let value = json.decode(&json.encode(&value).unwrap()).unwrap();
        prop_assert_eq!(to_json(&json.decode(&json.encode(&value).unwrap()).unwrap()), to_json(&value));
    }

    #[test]
    fn values_come_back_as_they_were(value in any_value(any_value(any_key()))) {
        for codec in ["cbor", "msgpack"] {
            let messages = MessageType::new(Some("rover.Measurement"), codec, None).unwrap();
            prop_assert_eq!(messages.decode(&messages.encode(&value).unwrap()).unwrap(), value.clone(), "{}", codec);
        }
        let json = MessageType::new(None, "json", None).unwrap();
        let bytes = json.encode(&value).unwrap();
        prop_assert_eq!(json.encode(&json.decode(&bytes).unwrap()).unwrap(), bytes);
    }

    #[test]
    fn yaml_comes_back_as_it_was(value in any_value(any_key())) {
        prop_assert_eq!(read_yaml(&to_yaml(&value)).unwrap(), value);
    }

    #[test]
    fn no_payload_panics(message in any_message(), value in any_value(any_key()), cut in any::<usize>(),
                         changes in prop::collection::vec((any::<usize>(), any::<u8>()), 0..6)) {
        for codec in ["protobuf", "json", "cbor", "msgpack"] {
            for name in ["rover.Measurement", "rover.Known"] {
                let messages = message_type(name, codec);
                let mut bytes = match codec {
                    "protobuf" => message.clone(),
                    "json" => to_json(&value).into_bytes(),
                    _ => messages.encode(&value).unwrap().to_vec(),
                };
                bytes.truncate(cut % (bytes.len() + 1));
                let length = bytes.len().max(1);
                for (place, byte) in &changes {
                    bytes.get_mut(place % length).into_iter().for_each(|old| *old = *byte);
                }
                if let Ok(value) = messages.decode(&bytes) {
                    let again = messages.encode(&value);
                    prop_assert!(again.is_ok(), "{:?}: {:?}", again, value);
                    read_yaml(&to_yaml(&value)).unwrap();
                }
                to_yaml(&messages.show(&bytes));
            }
        }
    }

    /// Checking a payload and decoding it agree.
    #[test]
    fn what_is_accepted_can_be_decoded(bytes in prop::collection::vec(any::<u8>(), 0..40)) {
        let descriptor = descriptor("rover.Measurement");
        let decoded = DynamicMessage::decode(descriptor, &bytes[..]);
        let shown = message_type("rover.Measurement", "protobuf").decode(&bytes);
        prop_assert_eq!(decoded.is_ok(), shown.is_ok(), "{:?} {:?}", decoded.err(), shown);
    }
}
