//! Parsing records whose lengths cannot be trusted, for everything that reads recordings.
//!
//! The `mcap` crate allocates as much memory as a length says. So the lengths in a record are checked against its
//! content first, and a decompressed chunk may be no longer than its compression allows.

use bytes::Buf;
use mcap::parse_record;
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::LinearReaderOptions;
use std::borrow::Cow;

/// Maximum compression ratio of LZ4: a byte of a length stands for 255 bytes.
const MOST_LZ4: usize = 255;
/// Maximum compression ratio of zstd: a block of four bytes stands for 128 KiB.
const MOST_ZSTD: usize = 32 << 10;

/// Length of the start of a chunk's content, up to and including the name of its compression if that is the longest one
/// known here.
const CHUNK_HEAD: usize = 36;

/// The supported compressions, for messages.
pub(crate) const COMPRESSIONS: &str = "lz4 and zstd";

/// Decompressed size that is allowed beyond the compression ratio, for short chunks.
const SHORT: usize = 64 << 10;

/// Maximum length of a record, and of a decompressed chunk. Anything longer is treated as garbage.
pub(crate) const LONGEST: usize = 1 << 30;

/// Parses one record; `None` if its content does not match its opcode. Records of the index are returned as
/// `Record::Unknown`, because nothing here needs them.
pub(crate) fn parse(opcode: u8, content: &[u8]) -> Option<Record<'_>> {
    match fields(opcode) {
        None => Some(Record::Unknown { opcode, data: Cow::Borrowed(content) }),
        Some(fields) => fits(fields, content).then(|| parse_record(opcode, content).ok())?,
    }
}

/// Options for reading one chunk of this length in the file, whose content begins with `head`.
pub(crate) fn chunk_options(head: &[u8], length: usize) -> LinearReaderOptions {
    let most = if head.get(28..CHUNK_HEAD) == Some(b"\x04\0\0\0zstd") { MOST_ZSTD } else { MOST_LZ4 };
    LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_record_length_limit(length.saturating_mul(most).saturating_add(SHORT).min(LONGEST))
}

/// A part of a record's content.
#[derive(Debug, Clone, Copy)]
enum Field {
    /// This many bytes.
    Fixed(usize),
    /// A text or block of bytes, preceded by its length in four bytes.
    Sized,
    /// A map of texts, preceded by its length in four bytes.
    TextMap,
    /// A block of bytes, preceded by its length in eight bytes.
    LongSized,
}

/// Returns the fields that a record must contain; `None` for records that are not parsed.
fn fields(opcode: u8) -> Option<&'static [Field]> {
    use Field::{Fixed, LongSized, Sized, TextMap};
    Some(match opcode {
        op::HEADER => &[Sized, Sized],
        op::SCHEMA => &[Fixed(2), Sized, Sized, Sized],
        op::CHANNEL => &[Fixed(4), Sized, Sized, TextMap],
        op::MESSAGE => &[Fixed(22)],
        op::ATTACHMENT => &[Fixed(16), Sized, Sized, LongSized, Fixed(4)],
        op::METADATA => &[Sized, TextMap],
        _ => return None,
    })
}

fn fits(fields: &[Field], content: &[u8]) -> bool {
    let mut rest = content;
    fields.iter().all(|field| skip(*field, &mut rest).is_some())
}

/// Removes a field from the beginning of `rest`. Returns its bytes without the length; `None` if the field does not
/// fit.
fn skip<'c>(field: Field, rest: &mut &'c [u8]) -> Option<&'c [u8]> {
    let length = match field {
        Field::Fixed(length) => length,
        Field::LongSized => usize::try_from(rest.try_get_u64_le().ok()?).ok()?,
        Field::Sized | Field::TextMap => usize::try_from(rest.try_get_u32_le().ok()?).ok()?,
    };
    let (content, left) = rest.split_at_checked(length)?;
    *rest = left;
    let mut texts = if matches!(field, Field::TextMap) { content } else { &[] };
    while !texts.is_empty() {
        skip(Field::Sized, &mut texts)?;
    }
    Some(content)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mcap::records::{AttachmentHeader, Channel, Header, Metadata, SchemaHeader};
    use std::collections::BTreeMap;

    fn text(text: &str) -> Vec<u8> {
        [&u32::try_from(text.len()).unwrap().to_le_bytes()[..], text.as_bytes()].concat()
    }

    fn map(pairs: &[(&str, &str)]) -> Vec<u8> {
        let texts: Vec<u8> = pairs.iter().flat_map(|(key, value)| [text(key), text(value)].concat()).collect();
        [&u32::try_from(texts.len()).unwrap().to_le_bytes()[..], &texts].concat()
    }

    /// A record of each kind that has lengths, as its opcode and content.
    fn records() -> [(u8, Vec<u8>); 5] {
        [
            (op::HEADER, [text("scl"), text("scl 0.1.0")].concat()),
            (op::SCHEMA, [vec![1, 0], text("rover.Event"), text("protobuf"), text("descriptors")].concat()),
            (op::CHANNEL, [vec![1, 0, 1, 0], text("/sensor/log"), text("json"), map(&[("kind", "pub")])].concat()),
            (
                op::ATTACHMENT,
                [&[0; 16][..], &text("plan"), &text("json"), &[2, 0, 0, 0, 0, 0, 0, 0], b"{}", &[0; 4]].concat(),
            ),
            (op::METADATA, [text("totals"), map(&[("system", "rover"), ("lost", "0")])].concat()),
        ]
    }

    #[test]
    fn sound_records_are_parsed() {
        let parsed = records();
        let parsed: Vec<Record<'_>> = parsed.iter().map(|(opcode, content)| parse(*opcode, content).unwrap()).collect();
        let pair = |(key, value): (&str, &str)| (key.to_owned(), value.to_owned());
        let metadata = BTreeMap::from([("system", "rover"), ("lost", "0")].map(pair));
        assert!(matches!(&parsed[0], Record::Header(Header { profile, .. }) if profile == "scl"));
        assert!(matches!(&parsed[1], Record::Schema { header: SchemaHeader { id: 1, .. }, .. }));
        assert!(matches!(&parsed[2], Record::Channel(Channel { topic, .. }) if topic == "/sensor/log"));
        assert!(
            matches!(&parsed[3], Record::Attachment { header: AttachmentHeader { name, .. }, .. } if name == "plan")
        );
        assert!(
            matches!(&parsed[4], Record::Metadata(Metadata { name, metadata: found }) if name == "totals" && *found == metadata)
        );
    }

    /// With any four bytes replaced by a huge number, which often makes one of the lengths huge, nothing is reserved
    /// for it: the address space of this test would not be large enough for all of them.
    #[test]
    fn lengths_beyond_the_record_are_refused() {
        let mut refused = 0;
        for (opcode, content) in records() {
            for at in 0..content.len().saturating_sub(4) {
                let mut damaged = content.clone();
                damaged[at..at + 4].copy_from_slice(&(u32::MAX - 7).to_le_bytes());
                refused += usize::from(parse(opcode, &damaged).is_none());
            }
            for length in 0..content.len() {
                assert!(parse(opcode, &content[..length]).is_none(), "{opcode} cut at {length}");
            }
        }
        assert!(refused > 50, "{refused}");
    }
}
