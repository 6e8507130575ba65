//! `scl check --fix`: applies sure fixes until there are none left.

mod damage;
mod diff;
mod edit;
mod replace_file;
#[cfg(test)]
mod tests;

use super::source::Source;
use crate::load::{STDIN, shown_path};
use damage::Damage;
use diff::unified_diff;
use edit::{BYTE_ORDER_MARK, FixGroup, apply, groups};
use replace_file::replace_file;
use scl_loader::Loaded;
use std::collections::HashSet;

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
    /// Why the file could not be written.
    pub(super) error: Option<String>,
}

/// Fixes a loaded file, and updates `loaded` if the text changes. Returns `None` if the file could not be read.
pub(super) fn fix_file(file: &Source<'_>, loaded: &mut Loaded, dry_run: bool) -> Option<Outcome> {
    let check = |text: &str| file.load_text(text);
    let source = loaded.sources.file(loaded.file?);
    let mark = if source.has_byte_order_mark() { BYTE_ORDER_MARK } else { "" };
    let old = format!("{mark}{}", source.text());
    let Fixed { loaded: new_loaded, text: new, applied } = fix(std::mem::take(loaded), old.clone(), check);
    *loaded = new_loaded;
    let path = file.path;
    let is_stdin = path.as_os_str() == STDIN;
    let out = match is_stdin {
        _ if dry_run => unified_diff(&shown_path(path), &old, &new),
        true => new.clone(),
        false => String::new(),
    };
    let is_written = !dry_run;
    let replaces_file = is_written && !is_stdin && applied > 0;
    let error = if replaces_file { replace_file(path, &old, &new).err() } else { None };
    if dry_run || error.is_some() {
        // Nothing was written, so report the problems of the unchanged text.
        *loaded = check(&old);
    }
    Some(Outcome { applied, is_written, out, error: error.map(|error| error.to_string()) })
}

/// A text with its sure fixes applied.
struct Fixed {
    /// The check of the new text.
    loaded: Loaded,
    /// The whole new text, with a byte order mark if the old one had one.
    text: String,
    /// Number of problems whose fixes were applied.
    applied: usize,
}

/// Applies the sure fixes of a loaded text. `check` loads and checks a changed text.
///
/// Fixes that overlap are applied one after the other. Each new text is checked, and fixes that do not make the file
/// better are not applied.
fn fix(loaded: Loaded, text: String, check: impl Fn(&str) -> Loaded) -> Fixed {
    let mut fixed = Fixed { loaded, text, applied: 0 };
    let mut refused: HashSet<String> = HashSet::new();
    let mut groups = fixed.next_groups(&refused);
    let most_checks = MOST_CHECKS.min(MOST_BYTES / fixed.text.len().max(1));
    for _ in 0..most_checks {
        if groups.is_empty() {
            break;
        }
        let text = apply(&fixed.text, &groups);
        let loaded = check(&text);
        if helps(&fixed.loaded, &loaded, groups.len()) {
            fixed = Fixed { loaded, text, applied: fixed.applied + groups.len() };
            groups = fixed.next_groups(&refused);
        } else if let [only] = groups.as_slice() {
            refused.insert(only.problem.clone());
            groups = fixed.next_groups(&refused);
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
    fn next_groups(&self, refused: &HashSet<String>) -> Vec<FixGroup> {
        groups(&self.loaded, refused)
    }
}
