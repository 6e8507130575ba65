//! The records inside a chunk, which is usually compressed.

use mcap::McapError;
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapResult, parse_record};

/// Greatest ratio of LZ4: a byte of a length stands for 255 bytes.
const MOST_COMPRESSION: usize = 255;
/// What a chunk may contain however short it is.
const SHORT: usize = 64 << 10;

/// Calls `each` for all records of a complete chunk, after its checksum was found right.
///
/// # Errors
/// The chunk is damaged, or compressed with an unknown method.
pub(super) fn read(content: &[u8], each: impl FnMut(Record<'_>)) -> McapResult<()> {
    let checked = options(content.len()).with_prevalidate_chunk_crcs(true);
    read_with(checked, content, each)
}

/// Returns the records at the beginning of a chunk that was cut off, which has no checksum.
pub(super) fn read_cut(content: &[u8]) -> Vec<Record<'static>> {
    let mut records = Vec::new();
    let _ends_with_an_error = read_with(options(content.len()), content, |record| records.push(record.into_owned()));
    records
}

/// Reads one record; `None` if it is not what its opcode says.
pub(super) fn parse(opcode: u8, content: &[u8]) -> Option<Record<'_>> {
    // The library assumes that an attachment has all of its parts.
    if opcode == op::ATTACHMENT && attachment_length(content).is_none_or(|length| length > content.len() as u64) {
        return None;
    }
    parse_record(opcode, content).ok()
}

/// No length that a damaged file announces makes the reader reserve more memory than the chunk can contain.
fn options(length: usize) -> LinearReaderOptions {
    LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_record_length_limit(length.saturating_mul(MOST_COMPRESSION).saturating_add(SHORT))
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

/// The length of an attachment's record: two times, two texts, the data, a checksum.
fn attachment_length(content: &[u8]) -> Option<u64> {
    let text = |offset: u64| {
        let start = usize::try_from(offset).ok()?;
        let length = content.get(start..)?.first_chunk::<4>()?;
        Some(offset + 4 + u64::from(u32::from_le_bytes(*length)))
    };
    let offset = text(text(16)?)?;
    let length = content.get(usize::try_from(offset).ok()?..)?.first_chunk::<8>()?;
    offset.checked_add(8 + 4)?.checked_add(u64::from_le_bytes(*length))
}
