//! Names of recordings: `rover_20261122T001530Z.mcap`, and `flight_0001.mcap` for the parts of a split one.

use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use scl_terminal::{Problem, timestamp};
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

const EXTENSION: &str = "mcap";

/// The file names of the recordings of one run.
#[derive(Debug)]
pub(crate) struct FileNames {
    path: PathBuf,
    numbering: Numbering,
    overwrite: bool,
    used: u32,
}

/// Which files get a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Numbering {
    /// All: the parts of a split recording.
    All,
    /// All but the first: a ring is seldom written twice.
    FromSecond,
}

impl FileNames {
    /// Chooses the names. `output` is a file, or a folder for a file with the default name; `None` is the working
    /// folder.
    ///
    /// # Errors
    /// The first file exists and may not be overwritten.
    pub(crate) fn new(
        output: Option<&Path>,
        system: &str,
        numbering: Numbering,
        overwrite: bool,
    ) -> Result<Self, Problem> {
        let name = || format!("{system}_{}.{EXTENSION}", compact_time(SystemTime::now()));
        let path = match output {
            None => PathBuf::from(name()),
            Some(folder) if folder.is_dir() => folder.join(name()),
            Some(path) => path.to_owned(),
        };
        let names = Self { path, numbering, overwrite, used: 0 };
        let first = names.numbered(1);
        if !overwrite && first.exists() {
            return Err(exists(&first));
        }
        Ok(names)
    }

    /// Creates the next file.
    ///
    /// # Errors
    /// The file exists and may not be overwritten, is being recorded by another process, or cannot be created.
    pub(crate) fn create_next(&mut self) -> Result<(PathBuf, File), Problem> {
        let path = self.numbered(self.used + 1);
        let mut options = OpenOptions::new();
        options.write(true);
        match self.overwrite {
            true => options.create(true),
            false => options.create_new(true),
        };
        let cannot_create = |error: io::Error| match error.kind() {
            ErrorKind::AlreadyExists => exists(&path),
            _ => Problem::new(format!("cannot create `{}`: {error}", path.display())),
        };
        let file = options.open(&path).map_err(cannot_create)?;
        // The lock is held until the file is closed; `scl recover` checks it, too. File systems without locks offer no
        // protection.
        if flock(&file, FlockOperation::NonBlockingLockExclusive) == Err(Errno::WOULDBLOCK) {
            return Err(Problem::new(format!("`{}` is being recorded by another process", path.display())));
        }
        if self.overwrite {
            file.set_len(0).map_err(cannot_create)?;
        }
        self.used += 1;
        Ok((path, file))
    }

    fn numbered(&self, number: u32) -> PathBuf {
        if self.numbering == Numbering::FromSecond && number == 1 {
            return self.path.clone();
        }
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let extension = self.path.extension().map_or(EXTENSION.into(), |extension| extension.to_string_lossy());
        self.path.with_file_name(format!("{stem}_{number:04}.{extension}"))
    }
}

fn exists(path: &Path) -> Problem {
    Problem::new(format!("`{}` exists already", path.display()))
        .help("choose another name with `-o`, or replace it with `--overwrite`")
}

/// `20261122T001530Z`: it sorts by time and needs no quotes in a shell.
fn compact_time(time: SystemTime) -> String {
    let text = timestamp(time).replace(['-', ':'], "");
    let seconds = text.split('.').next().unwrap_or_default();
    format!("{seconds}Z")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn times_have_no_separators() {
        let time = SystemTime::UNIX_EPOCH + Duration::from_millis(1_795_306_530_750);
        assert_eq!(compact_time(time), "20261122T001530Z");
    }

    #[test]
    fn parts_are_numbered() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("flight.mcap");
        for (numbering, first) in [(Numbering::All, "flight_0001.mcap"), (Numbering::FromSecond, "flight.mcap")] {
            let mut names = FileNames::new(Some(&path), "rover", numbering, true).unwrap();
            let mut next = || names.create_next().unwrap().0.file_name().unwrap().to_owned();
            assert_eq!((next(), next()), (first.into(), "flight_0002.mcap".into()));
        }
    }

    #[test]
    fn nothing_is_overwritten_without_leave() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("flight.mcap");
        std::fs::write(&path, "precious").unwrap();
        let problem = FileNames::new(Some(&path), "rover", Numbering::FromSecond, false).unwrap_err();
        assert!(problem.to_string().contains("exists already"), "{problem}");
        let default = FileNames::new(Some(folder.path()), "rover", Numbering::FromSecond, false).unwrap();
        assert!(default.numbered(1).file_name().unwrap().to_str().unwrap().starts_with("rover_2"));
    }
}
