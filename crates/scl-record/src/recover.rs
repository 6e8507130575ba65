//! Recovery: a complete file from a recording that was cut off.
//!
//! All records are read in order and written to a new file with an index. Of a chunk that is cut in the middle, the
//! messages before the cut are kept. A chunk with a wrong checksum is left out.
//!
//! In place, only a file without its end is replaced, and the old file is kept beside the new one: a file that looks
//! damaged here may be sound to another program.

mod target;

use crate::parse::{COMPRESSIONS, LONGEST};
use crate::progress::bar;
use crate::record::text_of;
use crate::recording::{Records, chunk};
use indicatif::ProgressBar;
use mcap::records::op;
use mcap::{MAGIC, McapError};
use scl_terminal::{Problem, bytes_text, closest_name, escape};
use std::fs::{self, File};
use std::io::{self, Read};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use target::Target;

/// The result of a recovery.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recovered {
    /// The complete recording.
    pub path: PathBuf,
    /// Number of messages in it.
    pub messages: u64,
    /// Bytes of the damaged recording outside of complete records. A chunk that was cut off counts in full, even if
    /// some of its messages were kept.
    pub dropped: u64,
    /// Whether the recording was complete before. In place, it is then left as it is.
    pub was_complete: bool,
    /// Path at which the damaged recording is kept, if the new file has its name.
    pub kept: Option<PathBuf>,
}

/// Recovers `input`, in place unless there is an `output`. The new file is written beside its final name and then
/// renamed; in place, the damaged file is kept with `.bak` appended to its name.
///
/// # Errors
/// The input cannot be read, is not a recording, or is being recorded; it has no message that can be recovered; in
/// place, it was closed properly, so that something inside it is damaged, or it has chunks of an unknown compression;
/// the output or the copy exists or cannot be written. After an error, the input is unchanged.
pub fn recover(input: &Path, output: Option<&Path>) -> Result<Recovered, Problem> {
    let file = File::open(input).map_err(|error| cannot_open(input, &error))?;
    let unreadable = |error: &io::Error| Problem::new(format!("cannot read `{}`: {error}", input.display()));
    let metadata = file.metadata().map_err(|error| unreadable(&error))?;
    if !metadata.is_file() {
        return Err(Problem::new(format!("`{}` is not a file", input.display())));
    }
    // A recorder holds the lock while it writes.
    if rustix::fs::flock(&file, rustix::fs::FlockOperation::NonBlockingLockShared).is_err() {
        return Err(Problem::new(format!("`{}` is being recorded", input.display())).help("stop the recorder first"));
    }
    // Resolve symbolic links, so that the file is replaced and not the link.
    let real = fs::canonicalize(input).map_err(|error| unreadable(&error))?;
    let target = output.unwrap_or(&real);
    if let Some(output) = output.filter(|output| output.exists()) {
        return Err(
            Problem::new(format!("`{}` exists already", output.display())).help("choose another name with `-o`")
        );
    }

    let size = metadata.len();
    let progress = bar(Some(size), "{bar:40} {bytes} of {total_bytes}, {eta} left");
    check_magic(input, &file, size)?;
    let shared = file.try_clone().map_err(|error| unreadable(&error))?;
    let mut records = Records::new(input, shared, MAGIC.len() as u64, size);
    let mut copy = Target::create(target, &metadata)?;
    let unwritable =
        |error: McapError| Problem::new(format!("cannot write `{}`: {}", target.display(), text_of(&error)));
    let copied = copy_records((&file, size), &mut records, &mut copy, &progress, &unwritable);
    progress.finish_and_clear();
    let Copied { messages, dropped, unsupported, is_complete } = copied?;
    let path = output.unwrap_or(input).to_owned();
    let mut recovered = Recovered { path, messages, dropped, was_complete: is_complete && dropped == 0, kept: None };
    if recovered.was_complete && output.is_none() {
        return Ok(recovered);
    }
    let reason = match unsupported {
        Some(name) => format!("its chunks are compressed with `{}`; scl reads {COMPRESSIONS}", escape(&name)),
        None => format!("{} of it are damaged", bytes_text(dropped as f64)),
    };
    let unchanged = |message: String| Problem::new(message).note("the file was not changed");
    if messages == 0 && !recovered.was_complete {
        let message = format!("no message can be recovered from `{}`", input.display());
        return Err(unchanged(if was_closed(&file, size) { format!("{message}: {reason}") } else { message }));
    }
    if output.is_some() {
        copy.publish()?;
        return Ok(recovered);
    }
    if was_closed(&file, size) {
        return Err(unchanged(format!("`{}` was closed properly, but {reason}", input.display())).help(format!(
            "`scl recover {} -o FILE` writes the {messages} messages that can be read",
            input.display()
        )));
    }
    recovered.kept = Some(copy.publish_keeping_old()?);
    Ok(recovered)
}

/// Whether the file ends with MCAP's magic bytes, so that nothing was cut off.
fn was_closed(file: &File, size: u64) -> bool {
    let mut end = [0; MAGIC.len()];
    let at = size.saturating_sub(MAGIC.len() as u64);
    at > 0 && file.read_exact_at(&mut end, at).is_ok() && end == MAGIC
}

#[derive(Default)]
struct Copied {
    messages: u64,
    dropped: u64,
    /// The name of an unknown compression, if a chunk has one.
    unsupported: Option<String>,
    is_complete: bool,
}

/// Copies the data section of a file of this size, up to its end or to where the file is cut off. `unwritable` turns an
/// error of the target into a problem.
fn copy_records(
    (file, size): (&File, u64),
    records: &mut Records,
    target: &mut Target,
    progress: &ProgressBar,
    unwritable: &dyn Fn(McapError) -> Problem,
) -> Result<Copied, Problem> {
    let mut copied = Copied::default();
    while let Some(header) = records.next()? {
        progress.set_position(header.offset);
        if header.opcode == op::CHUNK {
            let content = records.content(LONGEST as u64)?;
            let mut added = Ok(());
            let read = chunk::read_unparsed(&content, header.length, |opcode, body| {
                if added.is_ok() {
                    added = target.add_record(opcode, body).map(drop);
                }
                Ok(())
            });
            added.map_err(unwritable)?;
            if let Err(error) = read {
                copied.dropped += records.position() - header.offset;
                if let McapError::UnsupportedCompression(name) = error {
                    copied.unsupported = Some(name);
                }
            }
        } else if header.is_cut || header.opcode == 0 || header.length > LONGEST as u64 {
            copied.dropped += size - header.offset;
            break;
        } else if header.opcode == op::DATA_END {
            let rest = size - records.position();
            copied.is_complete = ends_well(file, size, records)?;
            copied.dropped += if copied.is_complete { 0 } else { rest };
            break;
        } else {
            let body = records.content(u64::MAX)?;
            if !target.add_record(header.opcode, &body).map_err(unwritable)? {
                copied.dropped += body.len() as u64;
            }
        }
    }
    target.finish().map_err(unwritable)?;
    copied.messages = target.messages();
    Ok(copied)
}

/// Whether summary, footer and magic follow, and nothing else.
fn ends_well(file: &File, size: u64, records: &mut Records) -> Result<bool, Problem> {
    let mut last = 0;
    while let Some(header) = records.next()? {
        if header.is_cut {
            return Ok(last == op::FOOTER && size - header.offset == MAGIC.len() as u64 && was_closed(file, size));
        }
        last = header.opcode;
    }
    Ok(false)
}

fn cannot_open(path: &Path, error: &io::Error) -> Problem {
    let problem = Problem::new(format!("cannot open `{}`: {error}", path.display()));
    if error.kind() != io::ErrorKind::NotFound {
        return problem;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names: Vec<String> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    match closest_name(&wanted, names.iter().map(String::as_str)) {
        Some(close) => problem.help(format!("did you mean `{}`?", path.with_file_name(close).display())),
        None => problem,
    }
}

fn check_magic(path: &Path, mut file: &File, size: u64) -> Result<(), Problem> {
    let mut magic = [0; MAGIC.len()];
    let reason = match file.read_exact(&mut magic) {
        Ok(()) if magic == MAGIC => return Ok(()),
        _ if size == 0 => return Err(Problem::new(format!("`{}` is empty", path.display()))),
        Ok(()) => "it does not begin with MCAP's magic bytes",
        Err(_) => "it is too short",
    };
    Err(Problem::new(format!("`{}` is not an MCAP file: {reason}", path.display())))
}

#[cfg(test)]
mod tests;
