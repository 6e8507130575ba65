//! Names of recordings: `rover_20261122T001530Z.mcap`, and `flight_0001.mcap` for the parts of a split one.

use scl_terminal::Problem;
use std::fs::{File, OpenOptions};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

const EXTENSION: &str = "mcap";

/// Where the recordings of one run go.
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
    /// `output` is a file, a folder for a file with the default name, or `None` for that in the working folder.
    ///
    /// # Errors
    /// The first file, or one with a number, exists and may not be overwritten.
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
    /// It exists and may not be overwritten, or cannot be created.
    pub(crate) fn create_next(&mut self) -> Result<(PathBuf, File), Problem> {
        let path = self.numbered(self.used + 1);
        let mut options = OpenOptions::new();
        options.write(true);
        match self.overwrite {
            true => options.create(true).truncate(true),
            false => options.create_new(true),
        };
        let file = options.open(&path).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => exists(&path),
            _ => Problem::new(format!("cannot create `{}`: {error}", path.display())),
        })?;
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

/// ISO 8601 without separators, in UTC, to the second: it sorts by time and needs no quotes in a shell.
fn compact_time(time: SystemTime) -> String {
    let seconds = time.duration_since(SystemTime::UNIX_EPOCH).unwrap_or(Duration::ZERO).as_secs();
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    // http://howardhinnant.github.io/date_algorithms.html#civil_from_days, for days after 1970 only.
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 { shifted_month + 3 } else { shifted_month - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}{month:02}{day:02}T{:02}{:02}{:02}Z", second / 3600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_written_as_in_iso_8601() {
        let cases = [
            (0, "19700101T000000Z"),
            (951_782_399, "20000228T235959Z"),
            (951_782_400, "20000229T000000Z"),
            (1_795_306_530, "20261122T001530Z"),
            (4_107_542_400, "21000301T000000Z"),
        ];
        for (seconds, expected) in cases {
            assert_eq!(compact_time(SystemTime::UNIX_EPOCH + Duration::from_secs(seconds)), expected);
        }
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
