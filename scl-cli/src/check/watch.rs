//! `--watch`: checks again whenever a file changes.
//!
//! The files are looked at ten times a second. That works on every file system and with every way in which editors write
//! files, and costs a few system calls.

use super::{COULD_NOT_RUN, CheckArguments, check_once};
use crate::print::print_err;
use crate::run::stop_signals;
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

/// How often the files are looked at.
const INTERVAL: Duration = Duration::from_millis(100);

/// The line before a check; editors may search for it, so it stays as it is.
const BEGIN: &str = "scl: checking\n";

/// The line after a check; likewise.
const END: &str = "scl: waiting for changes, Ctrl-C ends\n";

/// Checks until a signal asks to stop; gives the exit code of the last check.
pub(super) fn watch(arguments: &CheckArguments) -> ExitCode {
    let stop = match listen_for_stop() {
        Ok(stop) => stop,
        Err(error) => {
            print_err(&format!("error: cannot listen for signals: {error}\n"));
            return ExitCode::from(COULD_NOT_RUN);
        }
    };
    // What a file looks like is noted before it is read, so that no change is missed while it is read. Only of schemas
    // that a check meets for the first time it is noted right after.
    let mut before = Marks::of(&arguments.files);
    loop {
        print_err(BEGIN);
        let outcome = check_once(arguments);
        print_err(END);
        before = before.extended(&outcome.depends_on);
        match wait_for_change(before, &stop) {
            Some(now) => before = now,
            None => return ExitCode::from(outcome.code),
        }
        print_err("\n");
    }
}

/// Waits until a file differs from its mark, and then until it rests, as editors write files in several steps. Gives
/// `None` when asked to stop.
fn wait_for_change(before: Marks, stop: &Receiver<()>) -> Option<Marks> {
    let mut last = before.clone();
    loop {
        if stop.recv_timeout(INTERVAL).is_ok() {
            return None;
        }
        let now = last.renewed();
        if now == last && now != before {
            return Some(now);
        }
        last = now;
    }
}

/// What the files look like from outside.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Marks(Vec<(PathBuf, Option<Mark>)>);

/// Inode, size, change of the content and change of the entry in nanoseconds. `None` for a file that is not there.
type Mark = (u64, u64, i128, i128);

impl Marks {
    fn of(files: &[PathBuf]) -> Self {
        Self(Vec::new()).extended(files)
    }

    /// These files and no others; those that are marked already keep their mark.
    fn extended(&self, files: &[PathBuf]) -> Self {
        let mut marks: Vec<(PathBuf, Option<Mark>)> = Vec::new();
        for file in files {
            if marks.iter().all(|(known, _)| known != file) {
                let known = self.0.iter().find(|(known, _)| known == file);
                marks.push((file.clone(), known.map_or_else(|| mark(file), |(_, mark)| *mark)));
            }
        }
        Self(marks)
    }

    fn renewed(&self) -> Self {
        Self(self.0.iter().map(|(file, _)| (file.clone(), mark(file))).collect())
    }
}

fn mark(file: &Path) -> Option<Mark> {
    let about = std::fs::metadata(file).ok()?;
    let nanoseconds = |seconds: i64, rest: i64| i128::from(seconds) * 1_000_000_000 + i128::from(rest);
    let changed = nanoseconds(about.mtime(), about.mtime_nsec());
    Some((about.ino(), about.size(), changed, nanoseconds(about.ctime(), about.ctime_nsec())))
}

/// One thread waits for the signals, which are blocked in all others.
fn listen_for_stop() -> io::Result<Receiver<()>> {
    let signals = stop_signals();
    signals.thread_block()?;
    let (sender, stop) = channel();
    thread::Builder::new().spawn(move || {
        // Only a wrong set of signals fails; then nobody can stop us but by force, and so we stop at once.
        let _ = signals.wait();
        let _ = sender.send(());
    })?;
    Ok(stop)
}
