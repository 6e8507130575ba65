//! `SCL01xx`: where YAML is not YAML, or means something else than it seems to.

mod anchor;
pub(super) mod boolean_word;
pub(super) mod bracket;
mod conflict_marker;
pub(super) mod dash;
pub(super) mod depth;
pub(super) mod directive;
pub(super) mod duplicate_key;
mod empty_file;
pub(super) mod indentation;
mod invisible;
pub(super) mod leading_zero;
pub(super) mod look_alike;
pub(super) mod merge_key;
pub(super) mod missing_colon;
pub(super) mod missing_comma;
pub(super) mod missing_space;
pub(super) mod no_value;
pub(super) mod not_yaml;
pub(super) mod number_name;
pub(super) mod odd_key;
pub(super) mod quote;
pub(super) mod reserved_character;
pub(super) mod scan;
mod second_document;
pub(super) mod tab;
mod tab_separator;
mod tag;
pub(super) mod text_block_name;
pub(super) mod unexpected;

use crate::diagnostic::{Diagnostics, Rule};
use crate::source::{FileId, SourceFile, Span};
use crate::yaml::Tree;

/// All of them, by their codes.
pub(crate) const RULES: [&Rule; 29] = [
    &tab::RULE,
    &bracket::RULE,
    &missing_space::RULE,
    &quote::RULE,
    &indentation::RULE,
    &reserved_character::RULE,
    &duplicate_key::RULE,
    &boolean_word::RULE,
    &number_name::RULE,
    &no_value::RULE,
    &anchor::RULE,
    &merge_key::RULE,
    &tag::RULE,
    &second_document::RULE,
    &empty_file::RULE,
    &depth::RULE,
    &invisible::RULE,
    &directive::RULE,
    &text_block_name::RULE,
    &odd_key::RULE,
    &not_yaml::RULE,
    &missing_comma::RULE,
    &missing_colon::RULE,
    &dash::RULE,
    &unexpected::RULE,
    &conflict_marker::RULE,
    &look_alike::RULE,
    &leading_zero::RULE,
    &tab_separator::RULE,
];

/// The rules about words that YAML reads as something else, or that hold an invisible character.
pub(crate) const MISREAD: [&Rule; 4] =
    [&boolean_word::RULE, &number_name::RULE, &invisible::RULE, &text_block_name::RULE];

/// Where a rule looks: the file, and the text with every reported character replaced by spaces.
pub(super) struct Place<'s> {
    pub(super) source: &'s SourceFile,
    file: FileId,
}

impl<'s> Place<'s> {
    pub(super) fn new(source: &'s SourceFile, file: FileId) -> Self {
        Place { source, file }
    }

    /// The span of some bytes of the file.
    pub(super) fn span(&self, range: std::ops::Range<usize>) -> Span {
        Span { file: self.file, start: range.start as u32, end: range.end as u32 }
    }

    /// The line of a byte, from 1.
    pub(super) fn line(&self, at: usize) -> u32 {
        self.source.line(at as u32)
    }

    /// The bytes of the line below one that ends at a byte, without the line break; at the end of the file, nothing.
    pub(super) fn line_below(&self, end: usize) -> std::ops::Range<usize> {
        let text = self.source.text();
        let next = text[end..].find('\n').map_or(text.len(), |at| end + at + 1);
        self.line_range(next)
    }

    /// The bytes of the line of a byte, without the line break.
    pub(super) fn line_range(&self, at: usize) -> std::ops::Range<usize> {
        self.source.line_range(at as u32)
    }
}

/// The text as the parser shall see it.
pub(super) struct CheckedText {
    /// Of the same length as the file, with spaces where a reported character stood.
    pub(super) text: String,
    /// Tabs or invisible characters became spaces, so that what the parser says of the structure means nothing.
    pub(super) is_mended: bool,
    /// Two versions of the file stand in it, of which the text has the first.
    pub(super) has_conflict: bool,
}

/// The rules that need no parser.
pub(super) fn check_text(source: &SourceFile, file: FileId, problems: &mut Diagnostics) -> CheckedText {
    let place = Place { source, file };
    let mut text = source.text().to_owned();
    let conflict = conflict_marker::check(&place, &mut text);
    let has_conflict = conflict.is_some();
    problems.extend(conflict);
    let scan = scan::scan(&text);
    let is_cleaned = invisible::check(&place, &scan, &mut text, problems);
    directive::check(&place, &mut text, problems);
    let has_tabs = tab::check(&place, &scan, &mut text, problems);
    tab_separator::check(&place, &scan, &mut text, problems);
    CheckedText { text, is_mended: is_cleaned || has_tabs || has_conflict, has_conflict }
}

/// The rules about what the parser found, but not about what it means.
pub(super) fn check_tree(tree: &Tree, place: &Place<'_>, problems: &mut Diagnostics) {
    anchor::check(tree, place, problems);
    problems.extend(tree.tags.iter().map(|tag| tag::diagnose(*tag)));
    problems.extend(tree.second_document.map(|at| second_document::diagnose(place, at)));
    problems.extend(tree.too_deep.map(depth::diagnose));
    if tree.error.is_none() {
        problems.extend(empty_file::find(tree, place));
    }
}
