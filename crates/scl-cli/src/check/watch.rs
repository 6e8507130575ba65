//! `--watch`: checks again whenever a file changes.
//!
//! The files are polled ten times a second. That works on every file system and however an editor writes files, and
//! costs a few system calls.

use super::checked::Checked;
use super::report::report;
use super::{CheckArguments, check_files, worst_code};
use crate::exit::COULD_NOT_DO;
use scl_terminal::{output_is_closed, print_err};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::collections::BTreeMap;
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

/// How often the files are polled.
const INTERVAL: Duration = Duration::from_millis(100);

/// The line before a check. Editors may match it, so it must not change.
const BEGIN: &str = "scl: checking\n";

/// The line after a check, which must not change either.
const END: &str = "scl: waiting for changes; press Ctrl-C to stop\n";

/// Checks until a signal asks to stop. Returns the exit code of the last check.
pub(super) fn watch(arguments: &CheckArguments) -> ExitCode {
    let stop = match listen_for_stop() {
        Ok(stop) => stop,
        Err(error) => {
            print_err(&format!("error: cannot listen for signals: {error}\n"));
            return ExitCode::from(COULD_NOT_DO);
        }
    };
    let mut marks = Marks::new();
    loop {
        print_err(BEGIN);
        let (checked, before) = check_marked(arguments, marks);
        report(&checked, arguments.format);
        if output_is_closed() {
            return ExitCode::from(worst_code(&checked));
        }
        print_err(END);
        match wait_for_change(before, &stop) {
            Some(now) => marks = now,
            None => return ExitCode::from(worst_code(&checked)),
        }
        print_err("\n");
    }
}

/// Checks files whose marks were taken before they were read, so that no change is missed while they are read. Schemas
/// are known only after the topology was read, so the first check is repeated if there are any.
fn check_marked(arguments: &CheckArguments, mut marks: Marks) -> (Vec<Checked>, Marks) {
    add_marks(&mut marks, &arguments.files);
    loop {
        let checked = check_files(arguments);
        let files: Vec<PathBuf> = checked.iter().flat_map(Checked::depends_on).collect();
        if files.iter().all(|file| marks.contains_key(file)) {
            marks.retain(|file, _| files.contains(file));
            return (checked, marks);
        }
        add_marks(&mut marks, &files);
    }
}

/// Waits until a file differs from its mark, and then until no file changes any more, because editors write files in
/// several steps. Returns the new marks, or `None` when asked to stop.
fn wait_for_change(before: Marks, stop: &Receiver<()>) -> Option<Marks> {
    let mut last = before.clone();
    loop {
        if stop.recv_timeout(INTERVAL).is_ok() {
            return None;
        }
        let now: Marks = last.keys().map(|file| (file.clone(), mark(file))).collect();
        if now == last && now != before {
            return Some(now);
        }
        last = now;
    }
}

/// The state of the files, from their metadata; `None` for a file that does not exist.
type Marks = BTreeMap<PathBuf, Option<Mark>>;

/// Inode, size, and the time of the last status change (`ctime`) in seconds and nanoseconds. The modification time is
/// not used, because any program can set it.
type Mark = (u64, u64, i64, i64);

/// Adds the marks of these files; those that are marked already keep their mark.
fn add_marks(marks: &mut Marks, files: &[PathBuf]) {
    for file in files {
        marks.entry(file.clone()).or_insert_with(|| mark(file));
    }
}

fn mark(file: &Path) -> Option<Mark> {
    let about = std::fs::metadata(file).ok()?;
    Some((about.ino(), about.size(), about.ctime(), about.ctime_nsec()))
}

fn listen_for_stop() -> io::Result<Receiver<()>> {
    let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP])?;
    let (sender, stop) = channel();
    thread::Builder::new().spawn(move || signals.forever().next().map(|_| sender.send(())))?;
    Ok(stop)
}
