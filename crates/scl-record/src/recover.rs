//! Recovery: a complete file from a recording that was cut off.
//!
//! Everything that is there is read in order and written anew with an index. Of a chunk that is cut in the middle, the
//! messages before the cut are kept. A chunk whose checksum is wrong is left out.
//!
//! In place, only a file without its end is replaced, and stays beside the new one: what looks damaged here may be
//! sound to another program.

mod records;
mod target;

use crate::parse::COMPRESSIONS;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use mcap::{MAGIC, McapError};
use records::{ChunkEnd, FileRecord, FileRecords};
use scl_terminal::{Problem, bytes_text, closest_name, escape};
use std::fs::{self, File};
use std::io::{self, BufReader};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use target::Target;

/// What has become of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recovered {
    /// The complete recording.
    pub path: PathBuf,
    /// Messages in it.
    pub messages: u64,
    /// Bytes of the damaged recording outside of complete records. Of a chunk that is cut off, messages may have been
    /// kept nevertheless.
    pub dropped: u64,
    /// Whether the recording was complete before, so that it was left as it is.
    pub was_complete: bool,
    /// Where the damaged recording is, if the complete one has its name.
    pub kept: Option<PathBuf>,
}

/// Recovers `input`, in place unless there is an `output`. The new file is written beside its final name and then
/// renamed; in place, the damaged file stays under its name with `.bak` behind it.
///
/// # Errors
/// The input cannot be read, is no recording, or is being recorded; it has no message that can be recovered; in place,
/// it was closed in order, so that something inside it is damaged, or has chunks of an unknown compression; the output
/// or the copy exists or cannot be written. Then the input is as it was.
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
    // Through symbolic links, so that the file is replaced and not the link.
    let real = fs::canonicalize(input).map_err(|error| unreadable(&error))?;
    let target = output.unwrap_or(&real);
    if let Some(output) = output.filter(|output| output.exists()) {
        return Err(
            Problem::new(format!("`{}` exists already", output.display())).help("choose another name with `-o`")
        );
    }

    let size = metadata.len();
    let progress = progress_bar(size);
    let records = FileRecords::open(BufReader::with_capacity(1 << 20, &file), size)
        .map_err(|error| no_recording(input, size, &error))?;
    let mut copy = Target::create(target, &metadata)?;
    let copied = copy_records(records, &mut copy, &progress);
    progress.finish_and_clear();
    let Copied { messages, dropped, unsupported, is_complete } = copied.map_err(|error| match error {
        CopyError::Read(error) => unreadable(&error),
        CopyError::Write(error) => Problem::new(format!("cannot write `{}`: {}", target.display(), text_of(&error))),
    })?;
    let path = output.unwrap_or(input).to_owned();
    let mut recovered = Recovered { path, messages, dropped, was_complete: is_complete && dropped == 0, kept: None };
    if recovered.was_complete && output.is_none() {
        return Ok(recovered);
    }
    let reason = match unsupported {
        Some(name) => format!("its chunks are compressed with `{}`; scl reads {COMPRESSIONS}", escape(&name)),
        None => format!("{} of it are damaged", bytes_text(dropped as f64)),
    };
    let unchanged = |message: String| Problem::new(message).note("the file was left as it is");
    if messages == 0 && !recovered.was_complete {
        let message = format!("no message can be recovered from `{}`", input.display());
        return Err(unchanged(if was_closed(&file, size) { format!("{message}: {reason}") } else { message }));
    }
    if output.is_some() {
        copy.publish()?;
        return Ok(recovered);
    }
    if was_closed(&file, size) {
        return Err(unchanged(format!("`{}` was closed in order, but {reason}", input.display())).help(format!(
            "`scl recover {} -o FILE` writes the {messages} messages that can be read",
            input.display()
        )));
    }
    recovered.kept = Some(copy.publish_keeping_old()?);
    Ok(recovered)
}

/// Whether the file has its end, so that nothing was cut off.
fn was_closed(file: &File, size: u64) -> bool {
    let mut end = [0; MAGIC.len()];
    let at = size.saturating_sub(MAGIC.len() as u64);
    at > 0 && file.read_exact_at(&mut end, at).is_ok() && end == MAGIC
}

struct Copied {
    messages: u64,
    dropped: u64,
    /// An unknown compression of a chunk.
    unsupported: Option<String>,
    is_complete: bool,
}

#[derive(Debug)]
enum CopyError {
    Read(io::Error),
    Write(McapError),
}

impl From<io::Error> for CopyError {
    fn from(error: io::Error) -> Self {
        Self::Read(error)
    }
}

impl From<McapError> for CopyError {
    fn from(error: McapError) -> Self {
        Self::Write(error)
    }
}

fn copy_records(
    mut records: FileRecords<BufReader<&File>>,
    target: &mut Target,
    progress: &ProgressBar,
) -> Result<Copied, CopyError> {
    let mut unusable = 0;
    let mut unsupported = None;
    loop {
        progress.set_position(records.position());
        let Some(record) = records.next()? else { break };
        match record {
            FileRecord::Record(opcode, body) => {
                if !target.add_record(opcode, &body)? {
                    unusable += body.len() as u64;
                }
            }
            FileRecord::Chunk(chunk) => {
                let end =
                    chunk.read(|opcode, body| target.add_record(opcode, body).map(|_| ()).map_err(CopyError::from))?;
                match end {
                    ChunkEnd::Sound => {}
                    ChunkEnd::Damaged(size) => unusable += size,
                    ChunkEnd::Unsupported(size, name) => {
                        unusable += size;
                        unsupported = Some(name);
                    }
                }
            }
        }
    }
    target.finish()?;
    Ok(Copied {
        messages: target.messages(),
        dropped: unusable + records.rest(),
        unsupported,
        is_complete: records.is_complete(),
    })
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

fn no_recording(path: &Path, size: u64, error: &io::Error) -> Problem {
    if size == 0 {
        return Problem::new(format!("`{}` is empty", path.display()));
    }
    Problem::new(format!("`{}` is not an MCAP file: {error}", path.display()))
}

fn text_of(error: &McapError) -> String {
    match error {
        McapError::Io(error) => error.to_string(),
        other => other.to_string(),
    }
}

fn progress_bar(size: u64) -> ProgressBar {
    // Invisible unless standard error is a terminal.
    let bar = ProgressBar::with_draw_target(Some(size), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {bytes} of {total_bytes}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

#[cfg(test)]
mod tests;
