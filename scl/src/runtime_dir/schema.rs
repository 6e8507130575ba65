//! The files `<hash>.schema`: the protobuf messages that programs were built with.

use super::SystemDir;
use super::error::RuntimeDirError;
use super::small_file::write_temp;
use crate::spec::Schema;
use std::fs;

/// Maximum size of a schema file that is read, in bytes.
pub(super) const SCHEMA_LIMIT: u64 = 16 << 20;

/// Writes the descriptors of a component's messages, with mode 0600, unless the file exists.
///
/// Programs with the same messages share the file, so none of them removes it.
///
/// # Errors
///
/// [`RuntimeDirError`] if the hash cannot be the name of a file, or the file cannot be written.
pub(crate) fn publish_schema(dir: &SystemDir, schema: &Schema) -> Result<(), RuntimeDirError> {
    let path = dir.schema_file(schema.hash)?;
    let length = schema.descriptors.len() as u64;
    if fs::symlink_metadata(&path).is_ok_and(|found| found.is_file() && found.len() == length) {
        return Ok(());
    }
    write_temp(dir.folder(), &path, schema.descriptors)?.rename_and_keep(&path)
}
