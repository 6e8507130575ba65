//! The new file: written under a temporary name, then renamed.

use crate::parse::parse;
use crate::record::options;
use mcap::records::{Header, Record};
use mcap::write::NoSeek;
use mcap::{Attachment, McapError, McapResult, Writer};
use scl_terminal::Problem;
use std::borrow::Cow;
use std::fs::{self, File, Metadata};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Uncompressed size of a chunk.
const CHUNK: u64 = 1 << 20;

/// Lowest opcode of private records, which other programs define.
const PRIVATE: u8 = 0x80;

/// A new file that appears at `path` only when it is published.
pub(super) struct Target {
    path: PathBuf,
    /// Beside `path`; removed unless it is published.
    file: NamedTempFile,
    /// `None` before the header of the old file is known.
    output: Option<Writer<NoSeek<BufWriter<File>>>>,
    messages: u64,
    /// Bytes in the open chunk.
    pending: u64,
}

impl Target {
    /// Creates the temporary file beside `path`, with the permissions of the old file.
    pub(super) fn create(path: &Path, old: &Metadata) -> Result<Self, Problem> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let file = NamedTempFile::new_in(folder)
            .map_err(|error| Problem::new(format!("cannot create a file in `{}`: {error}", folder.display())))?;
        // Ignore errors: some file systems have no permissions, and the content matters more.
        let _copied = file.as_file().set_permissions(old.permissions());
        Ok(Self { path: path.to_owned(), file, output: None, messages: 0, pending: 0 })
    }

    /// Number of messages so far.
    pub(super) fn messages(&self) -> u64 {
        self.messages
    }

    /// Copies a record of the old file; returns false if the record cannot be parsed or does not fit the others.
    /// Records of the index are skipped, because the index is written anew.
    pub(super) fn add_record(&mut self, opcode: u8, body: &[u8]) -> McapResult<bool> {
        let Some(record) = parse(opcode, body) else { return Ok(false) };
        if let Record::Header(header) = record {
            self.open(Some(header))?;
            return Ok(true);
        }
        self.open(None)?;
        let Some(writer) = &mut self.output else { return Ok(false) };
        let added = match record {
            Record::Schema { header, data } => {
                writer.add_schema_with_id(header.id, &header.name, &header.encoding, &data).map(drop)
            }
            Record::Channel(channel) => writer
                .add_channel_with_id(
                    channel.id,
                    channel.schema_id,
                    &channel.topic,
                    &channel.message_encoding,
                    &channel.metadata,
                )
                .map(drop),
            Record::Message { header, data } => writer.write_to_known_channel(&header, &data).inspect(|()| {
                self.messages += 1;
                self.pending += data.len() as u64;
            }),
            Record::Attachment { header, data, .. } => writer.attach(&Attachment {
                log_time: header.log_time,
                create_time: header.create_time,
                name: header.name,
                media_type: header.media_type,
                data: Cow::Borrowed(&data),
            }),
            Record::Metadata(metadata) => writer.write_metadata(&metadata),
            Record::Unknown { opcode: PRIVATE.., data } => {
                writer.write_private_record(opcode, &data, Default::default())
            }
            _ => Ok(()),
        };
        if self.pending >= CHUNK {
            writer.flush()?;
            self.pending = 0;
        }
        match added {
            Ok(()) => Ok(true),
            Err(error @ (McapError::Io(_) | McapError::AttemptedWriteAfterFailure)) => Err(error),
            // The record contradicts another one, or refers to one that is missing.
            Err(_) => Ok(false),
        }
    }

    /// Writes the index.
    pub(super) fn finish(&mut self) -> McapResult<()> {
        self.open(None)?;
        if let Some(writer) = &mut self.output {
            writer.finish()?;
        }
        Ok(())
    }

    /// Gives the file its name, and keeps the old file under another name, which is returned.
    pub(super) fn publish_keeping_old(self) -> Result<PathBuf, Problem> {
        let mut kept = self.path.clone().into_os_string();
        kept.push(".bak");
        let kept = PathBuf::from(kept);
        // A hard link fails if the name is taken, and keeps the file in place until the new one replaces it.
        fs::hard_link(&self.path, &kept).map_err(|error| {
            Problem::new(format!("cannot keep the damaged file as `{}`: {error}", kept.display()))
                .help("name a new file with `-o`")
        })?;
        self.publish().inspect_err(|_| drop(fs::remove_file(&kept)))?;
        Ok(kept)
    }

    /// Writes the content through to the disk, then gives the file its name.
    pub(super) fn publish(self) -> Result<(), Problem> {
        let Self { path, file, output, .. } = self;
        let written = output.map_or(Ok(()), |writer| writer.into_inner().into_inner().flush());
        let published = written.and_then(|()| file.as_file().sync_all()).and_then(|()| Ok(file.persist(&path)?));
        published.map(drop).map_err(|error| Problem::new(format!("cannot write `{}`: {error}", path.display())))
    }

    fn open(&mut self, header: Option<Header>) -> McapResult<()> {
        if self.output.is_some() {
            return Ok(());
        }
        let mut options = options();
        if let Some(header) = header {
            options = options.profile(header.profile).library(header.library);
        }
        let file = self.file.as_file().try_clone()?;
        self.output = Some(options.create(NoSeek::new(BufWriter::new(file)))?);
        Ok(())
    }
}
