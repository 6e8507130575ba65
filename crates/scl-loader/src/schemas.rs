//! `schemas:` of a topology file: found, compiled without `protoc`, or refused with `SCL0406`.

#[cfg(feature = "protobuf")]
mod broken;
#[cfg(feature = "protobuf")]
mod compile;
#[cfg(feature = "protobuf")]
mod descriptors;
#[cfg(feature = "protobuf")]
mod disk;
#[cfg(feature = "protobuf")]
mod edition;
#[cfg(feature = "protobuf")]
mod entry;
#[cfg(feature = "protobuf")]
mod explain;
#[cfg(feature = "protobuf")]
mod folders;
#[cfg(feature = "protobuf")]
mod imports;
#[cfg_attr(not(feature = "protobuf"), allow(dead_code))]
mod lexemes;
#[cfg(feature = "protobuf")]
mod limits;
#[cfg(feature = "protobuf")]
mod mistake;
#[cfg_attr(not(feature = "protobuf"), allow(dead_code))]
mod outline;
#[cfg(feature = "protobuf")]
mod place;
pub mod rust;
#[cfg(not(feature = "protobuf"))]
mod switched_off;
#[cfg(feature = "protobuf")]
mod unlisted;
#[cfg(feature = "protobuf")]
pub mod walk;

#[cfg(feature = "protobuf")]
pub(crate) use compile::compile;
#[cfg(feature = "protobuf")]
pub use descriptors::files_for;
pub use outline::Outline;
#[cfg(not(feature = "protobuf"))]
pub(crate) use switched_off::compile;

use scl_topology::check::{SchemaMessages, UnlistedSchema};
use std::path::PathBuf;

/// The compiled schema files of a topology, with all that they import.
#[derive(Debug, Clone)]
pub struct Schemas {
    /// Each file after the files that it imports; comments are kept.
    #[cfg(feature = "protobuf")]
    pub file_descriptor_set: prost_types::FileDescriptorSet,
    /// The folders in which these files are found by their names, relative to that of the topology file, in order.
    #[cfg(feature = "protobuf")]
    pub folders: Vec<String>,
}

/// The result of compiling the schemas.
#[derive(Default)]
pub(crate) struct Compiled {
    /// The messages by entry of `schemas:`; `None` unless every file compiled.
    pub(crate) messages: Option<Vec<SchemaMessages>>,
    /// The schemas that the file does not name but that declare one of its types.
    pub(crate) unlisted: Vec<UnlistedSchema>,
    /// The compiled files; `None` unless every file compiled and their Rust names do not clash, or if there are none.
    pub(crate) schemas: Option<Schemas>,
    /// What the schemas seem to declare if one of them is wrong; otherwise empty.
    pub(crate) outlines: Vec<Outline>,
    /// The schema files that were read, wrong ones included.
    pub(crate) files_read: Vec<PathBuf>,
}
