//! Recording into one file, or into several files one after the other.

use super::contents::{Contents, attach_latest, attach_plan};
use super::file::{RecordingFile, WrittenFile};
use super::file_names::FileNames;
use super::gate::Message;
use super::write_error::WriteError;
use scl_terminal::Problem;
use std::collections::VecDeque;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Interval between flushes. A crash of the recorder loses at most one second: this, and the time until the queue is
/// polled again.
const FLUSH: Duration = Duration::from_millis(800);

/// How the error begins when a file cannot be written.
const STOPPED: &str = "recording stopped";

/// How a recording is distributed over files.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Split {
    /// A file ends when it has about this size.
    pub bytes: Option<u64>,
    /// A file ends after this time.
    pub time: Option<Duration>,
    /// Number of files to keep; older ones of this run are deleted.
    pub keep: Option<usize>,
}

/// Writes messages into the current file.
pub(crate) struct Continuous {
    names: FileNames,
    split: Split,
    sync: Option<Duration>,
    /// The current file; `None` after a failure.
    file: Option<RecordingFile>,
    started: Instant,
    flushed: Instant,
    synced: Instant,
    finished: VecDeque<WrittenFile>,
    finished_bytes: u64,
    deleted: usize,
}

impl Continuous {
    /// Starts the first file. `sync` is how often everything is forced to the disk.
    pub(crate) fn start(
        names: FileNames,
        split: Split,
        sync: Option<Duration>,
        contents: &Contents,
    ) -> Result<Self, Problem> {
        let now = Instant::now();
        let mut continuous = Self {
            names,
            split,
            sync,
            file: None,
            started: now,
            flushed: now,
            synced: now,
            finished: VecDeque::new(),
            finished_bytes: 0,
            deleted: 0,
        };
        continuous.start_file(contents)?;
        Ok(continuous)
    }

    /// Path of the current file.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.file.as_ref().map(RecordingFile::path)
    }

    /// Bytes of all files so far.
    pub(crate) fn bytes(&self) -> u64 {
        self.finished_bytes + self.file.as_ref().map_or(0, RecordingFile::size)
    }

    pub(crate) fn write(&mut self, message: Message, contents: &Contents) -> Result<(), Problem> {
        if message.lost_before > 0 {
            self.count_lost(message.gate, message.lost_before);
        }
        self.with_file(|file| file.write(&message))?;
        let size = self.file.as_ref().map_or(0, RecordingFile::size);
        if self.split.bytes.is_some_and(|limit| size >= limit) { self.next_file(contents) } else { Ok(()) }
    }

    pub(crate) fn add_last_gate(&mut self, contents: &Contents) -> Result<(), Problem> {
        let Some((gate, before)) = contents.gates.split_last() else { return Ok(()) };
        self.with_file(|file| file.add_gate(before.len(), gate))
    }

    pub(crate) fn attach_plan(&mut self, contents: &Contents) -> Result<(), Problem> {
        self.with_file(|file| attach_plan(file, &contents.plan))
    }

    pub(crate) fn attach_latest(&mut self, name: &str, latest: &[u8]) -> Result<(), Problem> {
        self.with_file(|file| attach_latest(file, name, latest))
    }

    pub(crate) fn count_lost(&mut self, gate: usize, lost: u64) {
        if let Some(file) = &mut self.file {
            file.count_lost(gate, lost);
        }
    }

    pub(crate) fn flush(&mut self) -> Result<(), Problem> {
        self.flushed = Instant::now();
        self.with_file(RecordingFile::flush)
    }

    /// Does what is due: flushes, syncs, starts the next file.
    pub(crate) fn keep_up(&mut self, contents: &Contents) -> Result<(), Problem> {
        if self.flushed.elapsed() >= FLUSH {
            self.flush()?;
            self.with_file(|file| file.check_name())?;
        }
        if self.sync.is_some_and(|period| self.synced.elapsed() >= period) {
            self.flush()?;
            self.with_file(|file| Ok(file.sync().map_err(mcap::McapError::from)?))?;
            self.synced = Instant::now();
        }
        if self.split.time.is_some_and(|limit| self.started.elapsed() >= limit) {
            self.next_file(contents)
        } else {
            Ok(())
        }
    }

    /// Completes the current file. Returns the written files, the number of deleted ones, and what went wrong.
    pub(crate) fn finish(mut self) -> (Vec<WrittenFile>, usize, Option<Problem>) {
        let problem = self.finish_file().err();
        (self.finished.into(), self.deleted, problem)
    }

    fn next_file(&mut self, contents: &Contents) -> Result<(), Problem> {
        self.finish_file()?;
        self.start_file(contents)?;
        while self.split.keep.is_some_and(|keep| self.finished.len() >= keep) {
            let Some(oldest) = self.finished.pop_front() else { break };
            // The user may have moved the file; then there is nothing to delete.
            if fs::remove_file(&oldest.path).is_ok() {
                self.deleted += 1;
            }
        }
        Ok(())
    }

    fn start_file(&mut self, contents: &Contents) -> Result<(), Problem> {
        let (path, file) = self.names.create_next()?;
        let started = contents.start_file(path.clone(), file).map_err(|error| error.problem(STOPPED, &path))?;
        self.file = Some(started);
        (self.started, self.flushed) = (Instant::now(), Instant::now());
        Ok(())
    }

    /// Runs `action` on the current file. If the disk is full or the file was moved, the file is completed; if a write
    /// fails, the file is ended at its last flush.
    fn with_file(&mut self, action: impl FnOnce(&mut RecordingFile) -> Result<(), WriteError>) -> Result<(), Problem> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let Err(error) = action(file) else { return Ok(()) };
        let problem = error.problem(STOPPED, file.path());
        match error {
            WriteError::Full(_) | WriteError::Moved(_) => self.finish_file()?,
            WriteError::Failed(_) => self.abandon_file(),
        }
        Err(problem)
    }

    fn finish_file(&mut self) -> Result<(), Problem> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let finished = file.flush().and_then(|()| file.finish());
        match finished {
            Ok(written) => {
                if self.sync.is_some() {
                    // If the sync fails, the file is still readable, but not yet safe on the disk.
                    let _synced = file.sync();
                }
                let named = file.check_name().map_err(|error| error.problem(STOPPED, file.path()));
                self.file = None;
                if named.is_ok() {
                    self.add_finished(written);
                }
                named
            }
            Err(error) => {
                let problem = error.problem(STOPPED, file.path());
                self.abandon_file();
                Err(problem)
            }
        }
    }

    fn abandon_file(&mut self) {
        if let Some(file) = self.file.take() {
            self.add_finished(file.abandon());
        }
    }

    fn add_finished(&mut self, written: WrittenFile) {
        self.finished_bytes += written.bytes;
        self.finished.push_back(written);
    }
}
