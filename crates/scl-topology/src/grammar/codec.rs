//! The codecs: how messages become bytes.

/// A codec.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Codec {
    /// A codec of the framework.
    BuiltIn(&'static CodecRow),
    /// A codec of the user's own, by its Rust path, for example `my_crate::Flat`.
    Path(String),
}

/// What the file format says about a codec of the framework.
#[derive(Debug, PartialEq, Eq, Hash)]
pub struct CodecRow {
    /// The word in the file, and the cargo feature of the crate `scl`.
    pub word: &'static str,
    /// The Rust type in `scl::codec`.
    pub rust: &'static str,
    /// Whether the cargo feature is on by default.
    pub is_default_feature: bool,
    /// Whether it carries the messages of `schemas`, not only Rust types.
    pub carries_schema_types: bool,
    /// Which messages it supports, in one sentence.
    pub messages: &'static str,
    /// When to choose it, in one sentence.
    pub summary: &'static str,
    /// What to do about a Rust type that it does not support.
    pub remedy: &'static str,
    /// Other words that people write for it, in lower case.
    pub synonyms: &'static [&'static str],
}

const SERDE_TYPES: &str = "Types that derive `serde::Serialize` and `serde::Deserialize`.";
const SERDE_REMEDY: &str = "derive `serde::Serialize` and `serde::Deserialize` for it";

/// The codec of typed gates in a file that names none.
const PROTOBUF: CodecRow = CodecRow {
    word: "protobuf",
    rust: "Protobuf",
    is_default_feature: true,
    carries_schema_types: true,
    messages: "Messages of the file's `schemas`, and types that derive `prost::Message`.",
    summary: "Binary, understood in every language; the default.",
    remedy: "derive `prost::Message` for it, or name a `.proto` file in `schemas:`",
    synonyms: &["proto", "pb", "prost", "proto2", "proto3", "protobuf3", "grpc", "protocolbuffers"],
};

/// The codec of gates without a type.
const RAW: CodecRow = CodecRow {
    word: "raw",
    rust: "Raw",
    is_default_feature: true,
    carries_schema_types: false,
    messages: "Types of fixed layout that derive the traits of `zerocopy`.",
    summary: "The bytes of the type as they are in memory: the fastest, but only between processors of the same \
              kind.",
    remedy: "derive the traits of `zerocopy` for it; it must have a fixed layout",
    synonyms: &["bytes", "none", "binary", "octetstream", "zerocopy", "pod"],
};

impl Codec {
    /// The codecs of the framework, in the order in which messages list them.
    pub const BUILT_IN: &[CodecRow] = &[
        PROTOBUF,
        CodecRow {
            word: "json",
            rust: "Json",
            is_default_feature: true,
            carries_schema_types: true,
            messages: "Messages of `schemas` in protobuf's canonical form, and types that derive \
                       `serde::Serialize` and `serde::Deserialize`.",
            summary: "Text, readable in every tool and language.",
            remedy: SERDE_REMEDY,
            synonyms: &["text", "serdejson", "jsonl"],
        },
        CodecRow {
            word: "cbor",
            rust: "Cbor",
            is_default_feature: false,
            carries_schema_types: false,
            messages: SERDE_TYPES,
            summary: "Binary and self-describing, a standard of the IETF.",
            remedy: SERDE_REMEDY,
            synonyms: &["ciborium", "rfc8949"],
        },
        CodecRow {
            word: "msgpack",
            rust: "Msgpack",
            is_default_feature: false,
            carries_schema_types: false,
            messages: SERDE_TYPES,
            summary: "Binary and self-describing, known in many languages.",
            remedy: SERDE_REMEDY,
            synonyms: &["messagepack", "mpack", "rmp", "rmpserde"],
        },
        CodecRow {
            word: "postcard",
            rust: "Postcard",
            is_default_feature: false,
            carries_schema_types: false,
            messages: SERDE_TYPES,
            summary: "Binary and small, between Rust programs.",
            remedy: SERDE_REMEDY,
            synonyms: &[],
        },
        RAW,
    ];

    /// The codec of typed gates in a file that names none: `protobuf`.
    pub const DEFAULT: Codec = Codec::BuiltIn(&PROTOBUF);

    /// The codec of gates without a type: `raw`.
    pub const RAW: Codec = Codec::BuiltIn(&RAW);

    /// The row of the table; `None` for a codec of the user's own.
    pub const fn row(&self) -> Option<&'static CodecRow> {
        match self {
            Codec::BuiltIn(row) => Some(row),
            Codec::Path(_) => None,
        }
    }

    /// Whether it can carry the messages of `schemas`; a codec of the user's own is assumed to.
    pub fn carries_schema_types(&self) -> bool {
        self.row().is_none_or(|row| row.carries_schema_types)
    }

    /// The codec of the framework with this word.
    pub fn of(word: &str) -> Option<Self> {
        Self::BUILT_IN.iter().find(|row| row.word == word).map(Self::BuiltIn)
    }

    /// The words of all codecs of the framework.
    pub fn words() -> impl Iterator<Item = &'static str> {
        Self::BUILT_IN.iter().map(|row| row.word)
    }

    /// The word in the file.
    pub fn word(&self) -> &str {
        match self {
            Codec::BuiltIn(row) => row.word,
            Codec::Path(path) => path,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Codec;

    /// A file of the crate `scl`.
    fn runtime(path: &str) -> String {
        std::fs::read_to_string(format!("{}/../../scl/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap()
    }

    #[test]
    fn each_codec_of_the_runtime_has_a_row() {
        let folder = format!("{}/../../scl/src/codec", env!("CARGO_MANIFEST_DIR"));
        let texts = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
        let texts = texts.map(|path| std::fs::read_to_string(path).unwrap());
        let mut words: Vec<String> = texts
            .filter_map(|text| {
                let (_, name) = text.split_once("const NAME: &'static str = \"")?;
                name.split('"').next().map(str::to_owned)
            })
            .filter(|word| word != "bytes")
            .collect();
        words.sort();
        let mut rows: Vec<&str> = Codec::words().collect();
        rows.sort_unstable();
        assert_eq!(words, rows);
    }

    #[test]
    fn each_codec_exists_in_the_runtime() {
        let manifest = runtime("Cargo.toml");
        let default = manifest.lines().find(|line| line.starts_with("default = ")).unwrap();
        let tests = runtime("../tests/Cargo.toml");
        let tested = tests.lines().find(|line| line.starts_with("scl = ")).unwrap();
        for row in Codec::BUILT_IN {
            let (word, rust) = (row.word, row.rust);
            assert!(manifest.contains(&format!("\n{word} = [")), "no feature `{word}`");
            assert_eq!(default.contains(&format!("\"{word}\"")), row.is_default_feature, "{word}");
            let implementation = runtime(&format!("src/codec/{word}.rs"));
            assert!(implementation.contains(&format!("pub struct {rust};")), "{word}");
            assert!(implementation.contains(&format!("NAME: &'static str = \"{word}\";")), "{word}");
            assert!(runtime("src/codec.rs").contains(&format!("\n    \"{word}\" {word} {rust}\n")), "{rust}");
            assert!(runtime("tests/conformance_codecs.rs").contains(&format!("scl::codec::{rust}")), "{rust}");
            let is_tested = row.is_default_feature || tested.contains(&format!("\"{word}\""));
            assert!(is_tested, "the tests do not switch `{word}` on, see tests/Cargo.toml");
            assert_eq!(Codec::of(word).map(|codec| codec.word().to_owned()).as_deref(), Some(word));
        }
    }
}
