//! Where the logs of a system are.

use super::{OLDER_FILES, numbered};
use scl_text::gate_name::{from_file_name, in_file_name};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder with the logs of one system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogFolder {
    /// Its path.
    pub path: PathBuf,
}

impl LogFolder {
    /// The folder of a system, which need not exist. `None` if the system's name cannot be that of a folder, or neither
    /// `XDG_STATE_HOME` nor `HOME` is an absolute path. `env` returns the value of a variable.
    pub fn of(system: &str, env: &dyn Fn(&str) -> Option<OsString>) -> Option<Self> {
        let path = is_plain(system).then(|| state_folder(env)).flatten()?.join(system);
        Some(Self { path })
    }

    /// The names of all systems that have logs, sorted.
    pub fn systems(env: &dyn Fn(&str) -> Option<OsString>) -> Vec<String> {
        let Some(folder) = state_folder(env) else { return Vec::new() };
        let mut systems = names(&folder);
        systems.retain(|name| !Self { path: folder.join(name) }.components().is_empty());
        systems
    }

    /// The names of the components that have a log, sorted.
    pub fn components(&self) -> Vec<String> {
        let logs = names(&self.path).into_iter();
        logs.filter_map(|name| name.strip_suffix(".log").map(from_file_name)).collect()
    }

    pub(super) fn file_of(&self, component: &str) -> Option<PathBuf> {
        is_plain(component).then(|| self.path.join(format!("{}.log", in_file_name(component))))
    }

    /// The existing files of a component's log, the oldest first.
    pub(super) fn files_of(&self, component: &str) -> Vec<PathBuf> {
        let Some(newest) = self.file_of(component) else { return Vec::new() };
        let files = (0..=OLDER_FILES).rev().map(|number| numbered(&newest, number));
        files.filter(|file| file.is_file()).collect()
    }
}

/// Returns the folder with the logs of all systems. The XDG Base Directory Specification declares relative paths
/// invalid.
fn state_folder(env: &dyn Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let absolute = |name| env(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let state = absolute("XDG_STATE_HOME").or_else(|| Some(absolute("HOME")?.join(".local/state")))?;
    Some(state.join("scl"))
}

/// Whether a name stays inside its folder.
fn is_plain(name: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || "_-.~".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(fits)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort_unstable();
    names
}
