//! Comparing the protobuf messages of this program with those of a peer, by their schema files.

use super::SystemDir;
use super::schema::SCHEMA_LIMIT;
use super::small_file::read_file;
use crate::spec::{ComponentSpec, GateSpec};
use scl_shape::{Difference, Encoding};

/// Compares the messages of a gate with those of its peer, which announced the hash `theirs`.
///
/// # Errors
/// The first difference, or why the messages cannot be compared; `peer` is the peer's name for that text.
pub(super) fn compare_messages(
    dir: &SystemDir,
    own: &ComponentSpec,
    gate: &GateSpec,
    theirs: Option<&str>,
    peer: &str,
) -> Result<(), String> {
    let (Some(ours), Some(theirs)) = (own.schema, theirs) else { return Ok(()) };
    // Only some codecs carry messages that are defined in schemas.
    let Some(encoding) = Encoding::of_codec(gate.codec).filter(|_| ours.hash != theirs) else { return Ok(()) };
    let key = (gate.payload, gate.codec, ours.hash, theirs.to_owned());
    let result = match dir.compared().get(&key) {
        Some(known) => known,
        None => {
            let result = compare_files(dir, gate.payload, encoding, ours.descriptors, theirs).map_err(|reason| {
                format!("cannot compare the messages of {peer} with those of this program: {reason}")
            })?;
            dir.compared().insert(key, result.clone());
            result
        }
    };
    result.map_err(|difference| format!("{}; build both with the same schemas", difference.text(peer)))
}

/// The outer error says why the messages cannot be compared.
fn compare_files(
    dir: &SystemDir,
    payload: &str,
    encoding: Encoding,
    ours: &[u8],
    theirs: &str,
) -> Result<Result<(), Difference>, String> {
    let path = dir.schema_file(theirs).map_err(|_bad_name| "it announces a schema with an invalid name")?;
    let cannot_read = |error: &dyn std::fmt::Display| format!("cannot read `{}`: {error}", path.display());
    let theirs = read_file(&path, SCHEMA_LIMIT).map_err(|error| cannot_read(&error))?;
    let theirs = scl_shape::decode(&theirs).map_err(|error| cannot_read(&error))?;
    let ours = scl_shape::decode(ours).map_err(|error| format!("cannot read this program's schema: {error}"))?;
    Ok(scl_shape::compare(payload, encoding, &ours, &theirs))
}
