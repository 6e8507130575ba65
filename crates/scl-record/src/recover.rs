//! Recovery: a complete file from a recording that was cut off.
//!
//! Everything that is there is read in order and written anew with an index. Of a chunk that is cut in the middle, the
//! messages before the cut are kept. A chunk whose checksum is wrong is left out.

mod records;
mod target;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use mcap::McapError;
use records::{FileRecord, FileRecords};
use scl_terminal::{Problem, bytes_text, closest_name};
use std::fs::{self, File};
use std::io::{self, BufReader};
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
}

/// Recovers `input`, in place unless there is an `output`. The new file is written beside its final name and then
/// renamed, so that there always is one of the two.
///
/// # Errors
/// The input cannot be read, is no recording, or is being recorded; it has no message that can be recovered, or most of it
/// would be lost in place; the output exists or cannot be written. Then the input is as it was.
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
    let Copied { messages, dropped, unread, is_complete } = copied.map_err(|error| match error {
        CopyError::Read(error) => unreadable(&error),
        CopyError::Write(error) => Problem::new(format!("cannot write `{}`: {}", target.display(), text_of(&error))),
    })?;
    if is_complete && output.is_none() {
        return Ok(Recovered { path: input.to_owned(), messages, dropped, was_complete: true });
    }
    if messages == 0 && !is_complete {
        return Err(Problem::new(format!("no message can be recovered from `{}`", input.display()))
            .note("the file was left as it is"));
    }
    // What is unreadable now, another program may be able to read.
    if output.is_none() && unread > size / 2 {
        let (unread, size) = (bytes_text(unread as f64), bytes_text(size as f64));
        return Err(Problem::new(format!("{unread} of the {size} of `{}` cannot be read", input.display()))
            .help(format!("`scl recover {} -o FILE` writes the {messages} messages before them", input.display()))
            .note("the file was left as it is"));
    }
    copy.publish()?;
    let path = output.unwrap_or(input).to_owned();
    Ok(Recovered { path, messages, dropped, was_complete: is_complete })
}

struct Copied {
    messages: u64,
    dropped: u64,
    /// Those of the dropped bytes that follow the last record.
    unread: u64,
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
                unusable +=
                    chunk.read(|opcode, body| target.add_record(opcode, body).map(|_| ()).map_err(CopyError::from))?;
            }
        }
    }
    target.finish()?;
    Ok(Copied {
        messages: target.messages(),
        dropped: unusable + records.rest(),
        unread: records.rest(),
        is_complete: records.is_complete() && unusable == 0,
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
