//! What generated code needs to name Rust types that may be absent from a program.

/// The Rust type with this number in a topology file.
pub trait NamedType<const INDEX: usize> {
    /// The type, or a stand-in if the program cannot name it.
    type Type;
}

/// Implements a codec for a stand-in. No stand-in is ever encoded: a component with such a gate cannot be opened.
#[doc(hidden)]
#[macro_export]
macro_rules! __stand_in_codec {
    ($codec:ty, $stand_in:ty) => {
        impl $crate::codec::Codec<$stand_in> for $codec {
            const NAME: &'static str = "none";

            fn encode(
                _: &$stand_in,
                _: &mut $crate::bytes::BytesMut,
            ) -> ::core::result::Result<(), $crate::codec::EncodeError> {
                ::core::result::Result::Err($crate::codec::EncodeError::new("none", "its type is not found"))
            }

            fn decode(_: $crate::bytes::Bytes) -> ::core::result::Result<$stand_in, $crate::codec::DecodeError> {
                ::core::result::Result::Err($crate::codec::DecodeError::new("none", "its type is not found"))
            }
        }
    };
}

/// Expands to nothing: the feature of the codec is off.
#[doc(hidden)]
#[macro_export]
macro_rules! __no_stand_in_codec {
    ($codec:ty, $stand_in:ty) => {};
}
