//! `scl recover`: rebuilds a recording that was cut off.

use clap::Args;
use scl_record::recover::{Recovered, recover as recover_file};
use scl_terminal::{Problem, bytes_text, escape, print_out};
use std::path::PathBuf;
use std::process::ExitCode;

/// Repair a recording that was cut off, for example by a crash or a full disk.
///
/// Keeps every intact message, and writes a new index. Without `-o`, the file is replaced once the new one is
/// complete, and stays beside it as `flight.mcap.bak`. A file that was closed cleanly, but is damaged inside, is never
/// replaced.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl recover flight.mcap
  scl recover flight.mcap -o recovered.mcap

Exit code: 0 the recording is complete now, 2 it could not be read or written.")]
pub(crate) struct RecoverArguments {
    /// The recording.
    file: PathBuf,
    /// Write the complete recording to this file, and leave the damaged one as it is.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The body of `scl recover`.
pub(crate) fn recover(arguments: &RecoverArguments) -> Result<ExitCode, Problem> {
    let Recovered { path, messages, dropped, was_complete, kept } =
        recover_file(&arguments.file, arguments.output.as_deref())?;
    let path = path.to_string_lossy();
    let path = escape(&path);
    let mut text = match (was_complete, dropped) {
        (true, _) => format!("{path}: complete already, {messages} messages"),
        (false, 0) => format!("{path}: recovered {messages} messages"),
        (false, _) => {
            let dropped = bytes_text(dropped as f64);
            format!("{path}: recovered {messages} messages, {dropped} were incomplete or damaged")
        }
    };
    if let Some(kept) = kept {
        let folder = std::env::current_dir().unwrap_or_default();
        let kept = kept.strip_prefix(folder).unwrap_or(&kept).to_string_lossy();
        text += &format!("; the old file is now `{}`", escape(&kept));
    }
    print_out(&format!("{text}\n"));
    Ok(ExitCode::SUCCESS)
}
