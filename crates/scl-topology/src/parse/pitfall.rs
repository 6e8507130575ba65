//! `SCL01xx`: text that is not valid YAML, or means something else than it seems to.

pub(super) mod bracket;
mod bullet;
mod conflict_marker;
pub(super) mod cut_off;
pub(super) mod dash;
pub(super) mod depth;
mod empty_file;
mod flat;
pub(super) mod habit;
pub(super) mod indentation;
mod invisible;
pub(super) mod key;
pub(super) mod leading_zero;
pub(super) mod look_alike;
pub(super) mod misread_name;
pub(super) mod missing_mark;
pub(super) mod missing_space;
pub(super) mod needs_quotes;
pub(super) mod no_value;
pub(super) mod not_yaml;
pub(super) mod quote;
pub(super) mod reserved_character;
pub(super) mod scan;
mod shallow;
pub(super) mod tab;
pub(super) mod unexpected;
pub(super) mod unsupported;

use super::dialect::Dialect;
use crate::diagnostic::{Diagnostics, Rule};
use crate::source::SourceFile;
use crate::yaml::Tree;

/// All of them, by their codes.
pub(crate) const RULES: &[&Rule] = &[
    &tab::INDENT,
    &bracket::RULE,
    &missing_space::RULE,
    &quote::RULE,
    &indentation::RULE,
    &reserved_character::RULE,
    &key::DUPLICATE,
    &misread_name::BOOLEAN,
    &misread_name::NUMBER,
    &no_value::RULE,
    &unsupported::ANCHOR,
    &unsupported::MERGE_KEY,
    &unsupported::TAG,
    &unsupported::SECOND_DOCUMENT,
    &empty_file::RULE,
    &depth::RULE,
    &invisible::RULE,
    &unsupported::DIRECTIVE,
    &misread_name::TEXT_BLOCK,
    &key::NOT_A_WORD,
    &not_yaml::RULE,
    &missing_mark::COMMA,
    &missing_mark::COLON,
    &dash::RULE,
    &unexpected::RULE,
    &conflict_marker::RULE,
    &look_alike::RULE,
    &leading_zero::RULE,
    &tab::SEPARATOR,
    &needs_quotes::RULE,
    &habit::RULE,
    &shallow::RULE,
    &cut_off::RULE,
];

/// The rules about words that YAML reads as something else, or that hold an invisible character.
pub(crate) const MISREAD: [&Rule; 4] =
    [&misread_name::BOOLEAN, &misread_name::NUMBER, &invisible::RULE, &misread_name::TEXT_BLOCK];

/// The text that the parser reads.
pub(super) struct CheckedText {
    /// Of the same length as the file, with spaces where a reported character stood.
    pub(super) text: String,
    /// Tabs, invisible characters or one of two conflicting versions were replaced by spaces, so a syntax error that
    /// the parser reports means nothing.
    pub(super) is_mended: bool,
    /// The file holds two versions, left by a merge, of which `text` has the first one; or it is a template; or its
    /// lists have other marks than `-`, or no line is indented.
    pub(super) is_incomplete: bool,
}

/// Checks the rules that need no parser.
pub(super) fn check_text(source: &SourceFile, dialect: &Dialect, problems: &mut Diagnostics) -> CheckedText {
    let mut text = source.text().to_owned();
    let conflict = conflict_marker::check(source, &mut text);
    let has_conflict = conflict.is_some();
    problems.extend(conflict);
    let scan = scan::scan(&text);
    let is_cleaned = invisible::check(source, &scan, &mut text, problems);
    unsupported::check_directives(source, &mut text, dialect, problems);
    let has_template =
        habit::template::check_pointer(source, problems) || habit::template::check(source, &scan, &mut text, problems);
    let has_bullets = !has_conflict && bullet::check(source, &scan, dialect, problems);
    habit::template::check_arrows(source, &mut text, problems);
    habit::template::check_backslashes(source, &scan, &mut text, problems);
    let has_tabs = tab::check_indentation(source, &scan, &mut text, problems);
    tab::check_separators(source, &scan, &mut text, problems);
    let is_flat = (dialect.is_key)("gates") && flat::check(source, problems);
    let is_incomplete = has_conflict || has_template || has_bullets || is_flat;
    CheckedText { text, is_mended: is_cleaned || has_tabs || is_incomplete, is_incomplete }
}

/// Checks the rules about what the parser found, but not about what it means.
pub(super) fn check_tree(tree: &Tree, source: &SourceFile, dialect: &Dialect, problems: &mut Diagnostics) {
    match dialect.has_aliases {
        true => unsupported::check_aliases(tree, source, problems),
        false => unsupported::check_anchors(tree, source, problems),
    }
    problems.extend(tree.tags.iter().map(|tag| unsupported::tag(*tag, source, dialect)));
    problems.extend(tree.second_document.map(|at| unsupported::second_document(source, at, dialect)));
    problems.extend(tree.too_deep.map(|at| depth::diagnose(at, dialect)));
    if tree.error.is_none() {
        let mut found = Vec::new();
        tree.root.iter().for_each(|root| shallow::find(root, source, &mut found));
        problems.extend(found);
        problems.extend(empty_file::find(tree, source, dialect));
    }
}

#[cfg(test)]
mod tests;
