//! Which files belong to one recording.

use scl_terminal::Problem;
use std::path::{Path, PathBuf};

/// Returns the files that command line arguments name. Each argument is a file, a pattern such as `flight_*.mcap`, or
/// the name that was given to `scl record --split`, whose parts have a number at their end.
///
/// # Errors
/// An argument names no file.
pub fn find_files(arguments: &[PathBuf]) -> Result<Vec<PathBuf>, Problem> {
    let mut files = Vec::new();
    for argument in arguments {
        if argument.exists() {
            files.push(argument.clone());
            continue;
        }
        let name = argument.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let pattern = match name.split_once('*') {
            Some(pattern) => pattern,
            None => (argument.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default(), ".mcap"),
        };
        let folder = argument.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut found = matching(folder, pattern, name.contains('*'));
        if found.is_empty() {
            let problem = Problem::new(format!("there is no file `{}`", argument.display()));
            return Err(problem.help("name a file written by `scl record`"));
        }
        found.sort_by_key(|(number, path)| (*number, path.clone()));
        files.extend(found.into_iter().map(|(_, path)| path));
    }
    Ok(files)
}

/// Returns the files whose names have this start and end, each with the number in between; without `any`, only files
/// that have a number.
fn matching(folder: &Path, (start, end): (&str, &str), any: bool) -> Vec<(Option<u64>, PathBuf)> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let file = |entry: std::fs::DirEntry| {
        let name = entry.file_name();
        let between = name.to_str()?.strip_prefix(start)?.strip_suffix(end)?;
        let number = between.trim_start_matches(|c: char| !c.is_ascii_digit()).parse().ok();
        let separated = between.starts_with(['_', '-', '.']);
        (any || (number.is_some() && separated)).then(|| (number, entry.path()))
    };
    entries.filter_map(file).collect()
}
