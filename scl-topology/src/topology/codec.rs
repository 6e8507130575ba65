//! How messages become bytes.

/// A codec.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Codec {
    /// `protobuf`, the default of typed gates.
    Protobuf,
    /// `json`.
    Json,
    /// `cbor`.
    Cbor,
    /// `msgpack`.
    Msgpack,
    /// `postcard`.
    Postcard,
    /// `raw`: fixed layout; also the codec of gates without a type.
    Raw,
    /// A codec of the user's own, by its Rust path, for example `my_crate::Flat`.
    Path(String),
}

impl Codec {
    /// The codecs of the framework, in the order in which messages list them.
    pub const BUILT_IN: [Codec; 6] =
        [Codec::Protobuf, Codec::Json, Codec::Cbor, Codec::Msgpack, Codec::Postcard, Codec::Raw];

    /// Returns true if it can carry messages of the `schemas`; a codec of the user's own may.
    pub fn carries_schema_types(&self) -> bool {
        match self {
            Codec::Protobuf | Codec::Json | Codec::Path(_) => true,
            Codec::Cbor | Codec::Msgpack | Codec::Postcard | Codec::Raw => false,
        }
    }

    /// The word in the file.
    pub fn word(&self) -> &str {
        match self {
            Codec::Protobuf => "protobuf",
            Codec::Json => "json",
            Codec::Cbor => "cbor",
            Codec::Msgpack => "msgpack",
            Codec::Postcard => "postcard",
            Codec::Raw => "raw",
            Codec::Path(path) => path,
        }
    }
}
