//! What a file says about itself, learned without reading its messages.

use super::chunk;
use super::records::Records;
use crate::parse::parse;
use bytes::{Buf, Bytes};
use mcap::records::{Record, op};
use scl_terminal::Problem;
use std::collections::BTreeMap;
use std::path::Path;

/// Length of the beginning of a chunk, which has the times of its messages.
const CHUNK_TIMES: u64 = 16;

/// A file attached to a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Attachment {
    pub name: String,
    pub data: Bytes,
}

/// What a file says about itself.
#[derive(Debug, Default)]
pub(super) struct Overview {
    pub(super) attachments: Vec<Attachment>,
    /// By name.
    pub(super) metadata: BTreeMap<String, BTreeMap<String, String>>,
    /// `log_time` of the first and the last message.
    pub(super) times: Option<(u64, u64)>,
    /// How the file ends, if it is not complete: `ends in the middle of a record`.
    pub(super) ending: Option<String>,
}

impl Overview {
    /// Walks over a file.
    ///
    /// # Errors
    /// It cannot be read, is empty, or is not an MCAP file.
    pub(super) fn read(path: &Path) -> Result<Self, Problem> {
        let mut records = Records::open(path)?;
        let mut overview = Self::default();
        let mut is_complete = false;
        while let Some(header) = records.next()? {
            if header.is_cut {
                if header.opcode == op::CHUNK {
                    // Count what can still be read of a truncated chunk.
                    let content = records.content(u64::MAX)?;
                    let _ends_with_an_error = chunk::read(&content, header.length, |record| overview.add(record));
                }
                overview.ending = Some(format!("ends in the middle of a record, at byte {}", header.offset));
                return Ok(overview);
            }
            match header.opcode {
                op::CHUNK => overview.add_times(&records.content(CHUNK_TIMES)?),
                op::ATTACHMENT | op::METADATA | op::MESSAGE => {
                    let content = records.content(u64::MAX)?;
                    let damaged = || records.problem(header.offset, "the recording is damaged: unreadable record");
                    overview.add(parse(header.opcode, &content).ok_or_else(damaged)?);
                }
                op::DATA_END => {
                    is_complete = true;
                    break;
                }
                _ => {}
            }
        }
        if !is_complete {
            overview.ending = Some("was not closed: its recorder was killed or is still running".to_owned());
        }
        Ok(overview)
    }

    fn add(&mut self, record: Record<'_>) {
        match record {
            Record::Attachment { header, data, .. } => {
                self.attachments.push(Attachment { name: header.name, data: data.into_owned().into() });
            }
            Record::Metadata(metadata) => {
                self.metadata.insert(metadata.name, metadata.metadata);
            }
            Record::Message { header, .. } => self.add_time(header.log_time),
            _ => {}
        }
    }

    fn add_times(&mut self, mut content: &[u8]) {
        // The times of a chunk without messages are zero.
        if let (Ok(first), Ok(last @ 1..)) = (content.try_get_u64_le(), content.try_get_u64_le()) {
            self.add_time(first);
            self.add_time(last);
        }
    }

    fn add_time(&mut self, time: u64) {
        let (first, last) = self.times.unwrap_or((time, time));
        self.times = Some((first.min(time), last.max(time)));
    }
}
