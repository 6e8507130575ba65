//! The options of a recording, and the notes printed while it runs.

use super::contents::AttachedFile;
use super::continuous::Split;
use super::storage::Progress;
use crate::progress::bar;
use indicatif::ProgressBar;
use scl_terminal::{bytes_text, print_err};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Options of [`record`](super::record()).
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The gates (`sensor.measurements`) and components (`sensor`) to record; empty: all.
    pub gates: Vec<String>,
    /// Gates and components to leave out.
    pub exclude: Vec<String>,
    /// The file, or a folder for a file with the default name; `None`: the working folder.
    pub output: Option<PathBuf>,
    /// Whether existing files may be replaced.
    pub overwrite: bool,
    /// How long to record; `None`: until a signal.
    pub run_for: Option<Duration>,
    /// How to distribute the recording over files.
    pub split: Split,
    /// How often to force everything to the disk, against power loss.
    pub sync: Option<Duration>,
    /// Limit of the memory for messages queued for the disk, in bytes. The ring may use the same amount again.
    pub memory: usize,
    /// Keep messages in memory only, and write them when asked.
    pub ring: Option<RingOptions>,
    /// The topology file, which declares the gates of components that do not run yet.
    pub topology: PathBuf,
    /// Files to add to each recording.
    pub attached: Vec<AttachedFile>,
}

/// A recording that is kept in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RingOptions {
    /// Age of the oldest message that is kept.
    pub window: Duration,
    /// Whether to write the ring when recording ends, too.
    pub save_at_end: bool,
}

/// Notes on standard error, and a line of figures if that is a terminal.
#[derive(Debug, Clone)]
pub(crate) struct Notes {
    line: ProgressBar,
}

impl Notes {
    pub(crate) fn new() -> Self {
        Self { line: bar(None, "{elapsed:>4}  {msg}") }
    }

    pub(crate) fn say(&self, text: &str) {
        self.line.suspend(|| print_err(&format!("{text}\n")));
    }

    pub(crate) fn show(&self, progress: &Progress) {
        let load = |figure: &std::sync::atomic::AtomicU64| figure.load(Ordering::Relaxed);
        let (messages, lost) = (load(&progress.messages), load(&progress.lost));
        self.line
            .set_message(format!("{messages} messages, {lost} lost, {}", bytes_text(load(&progress.bytes) as f64)));
        self.line.tick();
    }

    /// Removes the line of figures.
    pub(crate) fn clear(&self) {
        self.line.finish_and_clear();
    }
}
