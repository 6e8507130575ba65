//! The records inside a chunk, which is usually compressed.

use crate::parse::{chunk_options, parse};
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader};
use mcap::{McapError, McapResult};

/// Calls `each` for all records of a chunk of this length, after its checksum was verified. A chunk that was cut off
/// cannot be verified; `each` is called for the records before the cut.
///
/// # Errors
/// The chunk is damaged, cut off, or compressed with an unknown method.
pub(super) fn read(content: &[u8], length: u64, mut each: impl FnMut(Record<'_>)) -> McapResult<()> {
    read_unparsed(content, length, |opcode, data| {
        each(parse(opcode, data).ok_or(McapError::UnexpectedEoc)?);
        Ok(())
    })
}

/// Like [`read`], but calls `each` with the opcode and the content of each record.
pub(crate) fn read_unparsed(
    content: &[u8],
    length: u64,
    mut each: impl FnMut(u8, &[u8]) -> McapResult<()>,
) -> McapResult<()> {
    let is_whole = content.len() as u64 == length;
    let options = chunk_options(content, content.len()).with_prevalidate_chunk_crcs(is_whole);
    let mut reader = LinearReader::new_with_options(options);
    let header = [&[op::CHUNK][..], &length.to_le_bytes()].concat();
    let mut left = [&header[..], content];
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(wanted) => {
                let part = left.iter_mut().find(|part| !part.is_empty());
                let Some(part) = part else {
                    reader.notify_read(0);
                    continue;
                };
                let (given, rest) = part.split_at(wanted.min(part.len()));
                reader.insert(given.len()).copy_from_slice(given);
                reader.notify_read(given.len());
                *part = rest;
            }
            LinearReadEvent::Record { data, opcode } => each(opcode, data)?,
        }
    }
    Ok(())
}
