//! The records inside a chunk, which is usually compressed.

use crate::parse::{chunk_options, parse};
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, McapResult};

/// Calls `each` for all records of a complete chunk, after its checksum was found right.
///
/// # Errors
/// The chunk is damaged, or compressed with an unknown method.
pub(super) fn read(content: &[u8], each: impl FnMut(Record<'_>)) -> McapResult<()> {
    let checked = chunk_options(content, content.len()).with_prevalidate_chunk_crcs(true);
    read_with(checked, content, each)
}

/// Returns the records at the beginning of a chunk that was cut off, which has no checksum.
pub(super) fn read_cut(content: &[u8]) -> Vec<Record<'static>> {
    let mut records = Vec::new();
    let _ends_with_an_error =
        read_with(chunk_options(content, content.len()), content, |record| records.push(record.into_owned()));
    records
}

fn read_with(options: LinearReaderOptions, content: &[u8], mut each: impl FnMut(Record<'_>)) -> McapResult<()> {
    let mut reader = LinearReader::new_with_options(options);
    let header = [&[op::CHUNK][..], &(content.len() as u64).to_le_bytes()].concat();
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
            LinearReadEvent::Record { data, opcode } => each(parse(opcode, data).ok_or(McapError::UnexpectedEoc)?),
        }
    }
    Ok(())
}
