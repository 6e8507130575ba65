//! Writes observations into the database, and goes on when that fails.
//!
//! | trouble | what follows |
//! |---|---|
//! | locked by another process | observations stay in memory, up to a limit, and are written later |
//! | full | the oldest observations make room for new ones |
//! | corrupt | the file is moved aside, and a new one begins |
//! | another program's, or of another version | [`Refused`]: nothing is changed |
//! | anything else | as if it were locked; when the file is first opened: [`Refused`] |

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::{fs, io, mem};

use super::database::{Database, OpenError, Trouble};
use super::statistics::{Observation, Summary};
use crate::ospecorr::Statistics;
use crate::ospecorr::occupancy::Channel;

/// How long observations are kept, in seconds.
pub const KEPT: f64 = 3600.0;

/// Blocks that are kept in memory while the database cannot be written: a minute of them.
const MOST_HELD: usize = 3000;

/// Suffix of the reserve file, which occupies space until the disk is full.
const RESERVE: &str = "-reserve";
const RESERVE_BYTES: usize = 512 << 10;

/// How long to wait before retrying a database that cannot be written, in microseconds. A locked one is retried at each
/// flush.
const RETRY_US: i64 = 1_000_000;

/// Where the database is, and how large it may become.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Path of the file.
    pub path: PathBuf,
    /// Maximum size of the file in bytes.
    pub max_bytes: u64,
}

/// Why this program cannot use the database.
#[derive(Debug, thiserror::Error)]
#[error(
    "cannot use the database `{path}`: {reason}\n  = help: choose another file with --database, or move this one away"
)]
pub struct Refused {
    path: String,
    reason: String,
}

/// Writes blocks of observations and answers queries.
pub struct Recorder {
    settings: Settings,
    /// `None` while it is not open.
    database: Option<Database>,
    was_opened: bool,
    /// Blocks that are not written yet, in the order of their times.
    held: VecDeque<Block>,
    newest_us: i64,
    lost: u64,
    trouble: Option<Trouble>,
    retry_at_us: i64,
    made_room: MadeRoom,
    report: Box<dyn FnMut(String) + Send>,
}

struct Block {
    time_us: i64,
    channels: Vec<Channel>,
}

/// Whether observations were removed because the database is full. When that does not help, because the disk itself is
/// full, it is not repeated: there would soon be no observations left.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MadeRoom {
    Never,
    Helped,
    DidNotHelp,
}

impl Recorder {
    /// Creates a recorder that calls `report` with a line about each event.
    pub fn new(settings: Settings, report: impl FnMut(String) + Send + 'static) -> Self {
        Self {
            settings,
            database: None,
            was_opened: false,
            held: VecDeque::new(),
            newest_us: 0,
            lost: 0,
            trouble: None,
            retry_at_us: 0,
            made_room: MadeRoom::Never,
            report: Box::new(report),
        }
    }

    /// Adds a block, to be written by the next [`flush`](Self::flush).
    pub fn add(&mut self, time_us: i64, channels: Vec<Channel>) {
        // Give each block a unique time, even if the clock was set back.
        self.newest_us = time_us.max(self.newest_us + 1);
        self.held.push_back(Block { time_us: self.newest_us, channels });
        if self.held.len() > MOST_HELD {
            self.held.pop_front();
            self.lost += 1;
        }
    }

    /// Writes the added blocks in one transaction. If that is not possible now, a later flush writes them.
    ///
    /// # Errors
    /// This program cannot use the database.
    pub fn flush(&mut self, now_us: i64) -> Result<(), Refused> {
        if self.held.is_empty() && self.database.is_some() || now_us < self.retry_at_us {
            return Ok(());
        }
        let mut result = self.write(now_us);
        match result.as_ref().err().and_then(trouble) {
            Some(Trouble::Corrupt) => {
                self.set_aside(&result)?;
                result = self.write(now_us);
            }
            Some(Trouble::Full) if self.made_room != MadeRoom::DidNotHelp => {
                self.make_room();
                result = self.write(now_us);
                self.made_room = if result.is_ok() { MadeRoom::Helped } else { MadeRoom::DidNotHelp };
            }
            _ => {}
        }
        match result {
            Ok(()) => {
                if self.made_room == MadeRoom::DidNotHelp {
                    self.made_room = MadeRoom::Helped;
                }
                self.end_trouble();
                Ok(())
            }
            Err(OpenError::Sqlite(error)) if self.was_opened || Trouble::of(&error) == Trouble::Locked => {
                self.begin_trouble(&error);
                if Trouble::of(&error) != Trouble::Locked {
                    self.retry_at_us = now_us + RETRY_US;
                }
                Ok(())
            }
            Err(error) => Err(self.refused(&error)),
        }
    }

    /// The statistics of the last `seconds`, also of blocks that are not written yet.
    pub fn answer(&self, seconds: f64, now_us: i64) -> Statistics {
        self.summarize(seconds, now_us).unwrap_or_else(|error| Statistics { channels: Vec::new(), error })
    }

    fn summarize(&self, seconds: f64, now_us: i64) -> Result<Statistics, String> {
        if !(seconds > 0.0 && seconds <= KEPT) {
            return Err(format!("seconds must be above 0 and at most {KEPT}, not {seconds}"));
        }
        let from_us = now_us.saturating_sub((seconds * 1e6) as i64);
        let database = self.database.as_ref().ok_or("the database is not open yet")?;
        let mut summary = Summary::default();
        let read = database.read(from_us, |observation| summary.add(observation));
        read.map_err(|error| format!("the database cannot be read: {error}"))?;
        self.observations().filter(|it| it.time_us >= from_us).for_each(|it| summary.add(it));
        Ok(Statistics { channels: summary.finish(), error: String::new() })
    }

    fn write(&mut self, now_us: i64) -> Result<(), OpenError> {
        if self.database.is_none() {
            self.database = Some(Database::open(&self.settings.path, self.settings.max_bytes)?);
            self.was_opened = true;
            // Fails if the disk is already full; then there is no reserve.
            let _ = fs::write(ending(&self.settings.path, RESERVE), vec![0; RESERVE_BYTES]);
        }
        if let Some(mut database) = self.database.take() {
            let written = database.write(self.observations(), now_us - (KEPT * 1e6) as i64);
            self.database = Some(database);
            written?;
        }
        self.held.clear();
        Ok(())
    }

    /// Returns the observations that are not written yet. Those whose power is not finite are left out: a detector may
    /// report them, but SQLite cannot store NaN.
    fn observations(&self) -> impl Iterator<Item = Observation> {
        self.held.iter().flat_map(|block| {
            let numbered = (0..).zip(&block.channels).filter(|(_, it)| it.power_db.is_finite());
            numbered.map(|(channel, it)| Observation {
                time_us: block.time_us,
                channel,
                power_db: it.power_db,
                occupied: it.occupied,
            })
        })
    }

    /// Moves the file to `<file>.corrupt-<n>`, together with its log.
    fn set_aside(&mut self, result: &Result<(), OpenError>) -> Result<(), Refused> {
        self.database = None;
        let path = &self.settings.path;
        let moved = (1..).map(|n| ending(path, &format!(".corrupt-{n}"))).find(|it| !it.exists());
        let moved = moved.unwrap_or_default();
        for log in ["-wal", "-shm"] {
            // Usually missing: SQLite removes these files when it closes the database.
            let _ = fs::rename(ending(path, log), ending(&moved, log));
        }
        fs::rename(path, &moved).map_err(|error| self.refused(&cannot_move(&moved, &error)))?;
        let error = result.as_ref().err().map(ToString::to_string).unwrap_or_default();
        self.say(&format!("is corrupt ({error}); it was moved to `{}`, and a new one begins", moved.display()));
        Ok(())
    }

    fn make_room(&mut self) {
        if self.made_room == MadeRoom::Never {
            self.say("is full; from now on the oldest observations make room for new ones");
        }
        // Free the reserve first: removing rows is a transaction too, and its log needs space.
        let _ = fs::remove_file(ending(&self.settings.path, RESERVE));
        if let Some(database) = &mut self.database
            && let Err(error) = database.remove_oldest()
        {
            self.say(&format!("cannot be pruned: {error}"));
        }
    }

    fn begin_trouble(&mut self, error: &rusqlite::Error) {
        let trouble = Some(Trouble::of(error));
        if self.trouble != trouble {
            self.trouble = trouble;
            self.say(&format!("cannot be written: {error}; keeping up to {MOST_HELD} blocks in memory"));
        }
    }

    fn end_trouble(&mut self) {
        let lost = mem::take(&mut self.lost);
        if self.trouble.take().is_some() {
            self.say(&format!("can be written again; {lost} blocks were lost"));
        }
    }

    fn say(&mut self, what: &str) {
        (self.report)(format!("the database `{}` {what}", self.settings.path.display()));
    }

    fn refused(&self, reason: &dyn std::error::Error) -> Refused {
        Refused { path: self.settings.path.display().to_string(), reason: reason.to_string() }
    }
}

fn trouble(error: &OpenError) -> Option<Trouble> {
    match error {
        OpenError::Sqlite(error) => Some(Trouble::of(error)),
        _ => None,
    }
}

fn cannot_move(to: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("it is corrupt, and cannot be moved to `{}`: {error}", to.display()))
}

/// Returns `path` with `more` appended.
fn ending(path: &Path, more: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(more);
    name.into()
}

#[cfg(test)]
mod tests;
