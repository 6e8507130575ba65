//! The result of checking one file: its diagnostics and its exit code.

use super::CheckArguments;
use super::deny::deny;
use super::fix::{Outcome, fix_file};
use super::refusals::Refusals;
use super::source::Source;
use crate::exit::COULD_NOT_DO;
use crate::load::shown_path;
use scl_loader::Loaded;
use scl_topology::diagnostic::{Diagnostic, MOST_LISTED, Severity, limit};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A file that was checked.
pub(super) struct Checked {
    /// As the user named it.
    pub(super) path: PathBuf,
    /// The loaded file, after the fixes if `--fix` has written any.
    pub(super) loaded: Loaded,
    /// The diagnostics to show: the first ones if there are many.
    pub(super) shown: Vec<Diagnostic>,
    /// How many there are of each severity.
    numbers: BTreeMap<Severity, usize>,
    /// What `scl generate` would refuse in languages that `--for` does not name, one line for each.
    pub(super) notes: Vec<String>,
    /// The result of `--fix`; `None` without it, or if the file could not be read.
    pub(super) outcome: Option<Outcome>,
}

/// Checks a file, fixes it if asked to, and chooses what is shown.
pub(super) fn check_file(path: &Path, arguments: &CheckArguments) -> Checked {
    let source = Source::new(path, arguments);
    let mut loaded = source.load();
    let outcome = arguments.fix.then(|| fix_file(&source, &mut loaded, arguments.dry_run)).flatten();
    let refusals = Refusals::of(&loaded, arguments);
    let all = std::mem::take(&mut loaded.diagnostics).into_iter().chain(refusals.problems);
    let all = all.map(|it| deny(it, &arguments.deny));
    let all: Vec<Diagnostic> = all.filter(|it| arguments.lints || it.severity != Severity::Lint).collect();
    let mut numbers = BTreeMap::new();
    all.iter().for_each(|it| *numbers.entry(it.severity).or_default() += 1);
    let shown = limit(all, MOST_LISTED, &shown_path(path));
    Checked { path: path.to_path_buf(), notes: refusals.notes, loaded, shown, numbers, outcome }
}

impl Checked {
    pub(super) fn code(&self) -> u8 {
        match &self.loaded {
            Loaded { file: None, .. } => COULD_NOT_DO,
            _ if self.outcome.as_ref().is_some_and(|outcome| outcome.error.is_some()) => COULD_NOT_DO,
            _ => u8::from(self.number_of(Severity::Error) > 0),
        }
    }

    pub(super) fn number_of(&self, severity: Severity) -> usize {
        self.numbers.get(&severity).copied().unwrap_or_default()
    }

    /// Returns the paths of the file, of those that it includes, of their schemas and their imports, also of files that
    /// do not exist yet.
    pub(super) fn depends_on(&self) -> Vec<PathBuf> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let model = &self.loaded.model;
        let included = model.include.iter().map(|entry| &entry.file);
        let named = included.chain(&model.schemas).map(|file| folder.join(&file.value));
        let read = self.loaded.files_read.iter().cloned();
        std::iter::once(self.path.clone()).chain(named).chain(read).collect()
    }
}
