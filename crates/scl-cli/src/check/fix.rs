//! `scl check --fix`: applies sure fixes until there are none left.

mod damage;
mod diff;
mod edit;
mod replace_file;
#[cfg(test)]
mod tests;

use super::source::{Source, Texts};
use crate::load::STDIN;
use damage::Damage;
use diff::unified_diff;
use edit::{BYTE_ORDER_MARK, FixGroup, apply, groups};
use replace_file::replace_file;
use scl_loader::Loaded;
use scl_topology::source::FileId;
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

/// Maximum number of bytes checked in total. It limits the time spent on fixes that do not help to a few seconds.
const MOST_BYTES: usize = 1 << 24;

/// Maximum number of checks of one file.
const MOST_CHECKS: usize = 1_000;

/// The result of fixing a file.
pub(super) struct Outcome {
    /// Number of problems that were fixed, or would be.
    pub(super) applied: usize,
    /// Whether the fixes are written to the file, or to standard output for standard input; false with `--dry-run`.
    pub(super) is_written: bool,
    /// Text for standard output: the diff with `--dry-run`, or the fixed text of standard input.
    pub(super) out: String,
    /// Which file could not be written, and why.
    pub(super) error: Option<String>,
}

/// Fixes a loaded file, and updates `loaded` if the text changes. Returns `None` if the file could not be read.
///
/// The files that it includes are fixed after it, each by itself.
pub(super) fn fix_file(file: &Source<'_>, loaded: &mut Loaded, dry_run: bool) -> Option<Outcome> {
    let main = whole_text(loaded, loaded.file?);
    let mut texts = Texts { main, included: BTreeMap::new() };
    let mut outcome = Outcome { applied: 0, is_written: !dry_run, out: String::new(), error: None };
    let included = loaded.included.iter().map(|included| Some(included.path.clone()));
    let files: Vec<Option<PathBuf>> = std::iter::once(None).chain(included).collect();
    let before = texts.clone();
    for included in files {
        // A fix may have removed the entry that includes the file.
        let Some(id) = file_id(loaded, included.as_deref()) else { continue };
        let old = whole_text(loaded, id);
        let with = |text: &str| texts.with(included.as_deref(), text);
        let check = |text: &str| file.load_texts(&with(text));
        let shown = loaded.sources.file(id).path().to_owned();
        let Fixed { loaded: new_loaded, text: new, applied } =
            fix(std::mem::take(loaded), included.as_deref(), old.clone(), check);
        *loaded = new_loaded;
        outcome.applied += applied;
        let path = included.as_deref().unwrap_or(file.path);
        let is_stdin = path.as_os_str() == STDIN;
        match is_stdin {
            _ if dry_run => outcome.out.push_str(&unified_diff(&shown, &old, &new)),
            true => outcome.out.push_str(&new),
            false => {}
        }
        let replaces_file = !dry_run && !is_stdin && applied > 0;
        let error = if replaces_file { replace_file(path, &old, &new).err() } else { None };
        if let Some(error) = error {
            // The file was not written, so report the problems of its unchanged text.
            *loaded = check(&old);
            outcome.error = Some(format!("cannot write `{shown}`: {error}"));
            return Some(outcome);
        }
        texts = with(&new);
    }
    if dry_run {
        *loaded = file.load_texts(&before);
    }
    Some(outcome)
}

/// The id of the topology file itself, or of one that it includes.
fn file_id(loaded: &Loaded, included: Option<&Path>) -> Option<FileId> {
    match included {
        Some(path) => loaded.included.iter().find(|file| file.path == path).map(|file| file.file),
        None => loaded.file,
    }
}

/// The text of a file, with its byte order mark.
fn whole_text(loaded: &Loaded, file: FileId) -> String {
    let source = loaded.sources.file(file);
    let mark = if source.has_byte_order_mark() { BYTE_ORDER_MARK } else { "" };
    format!("{mark}{}", source.text())
}

/// A text with its sure fixes applied.
struct Fixed {
    /// The check of all files, with the new text.
    loaded: Loaded,
    /// The whole new text, with a byte order mark if the old one had one.
    text: String,
    /// Number of problems whose fixes were applied.
    applied: usize,
}

/// Applies the sure fixes of a text: that of the topology file, or of one that it includes. `check` loads and checks
/// the topology with a changed text.
///
/// Fixes that overlap are applied one after the other. Each new text is checked, and fixes that do not make the file
/// better are not applied.
fn fix(loaded: Loaded, included: Option<&Path>, text: String, check: impl Fn(&str) -> Loaded) -> Fixed {
    let mut fixed = Fixed { loaded, text, applied: 0 };
    let mut refused: HashSet<String> = HashSet::new();
    let mut groups = fixed.next_groups(included, &refused);
    let others = fixed.loaded.included.iter().map(|file| fixed.loaded.sources.file(file.file).text().len());
    let length = fixed.text.len() + others.sum::<usize>();
    let most_checks = MOST_CHECKS.min(MOST_BYTES / length.max(1));
    for _ in 0..most_checks {
        if groups.is_empty() {
            break;
        }
        let text = apply(&fixed.text, &groups);
        let loaded = check(&text);
        if helps(&fixed.loaded, &loaded, groups.len()) {
            fixed = Fixed { loaded, text, applied: fixed.applied + groups.len() };
            groups = fixed.next_groups(included, &refused);
        } else if let [only] = groups.as_slice() {
            refused.insert(only.problem.clone());
            groups = fixed.next_groups(included, &refused);
        } else {
            groups.truncate(groups.len() / 2);
        }
    }
    fixed
}

/// Whether `count` fixes made a file better. Several fixes must remove at least as many problems, so that a useless one
/// cannot hide behind the others.
fn helps(before: &Loaded, after: &Loaded, count: usize) -> bool {
    let (before, after) = (Damage::of(before), Damage::of(after));
    after < before && (count == 1 || after.problems() + count <= before.problems())
}

impl Fixed {
    fn next_groups(&self, included: Option<&Path>, refused: &HashSet<String>) -> Vec<FixGroup> {
        file_id(&self.loaded, included).map_or_else(Vec::new, |file| groups(&self.loaded, file, refused))
    }
}
