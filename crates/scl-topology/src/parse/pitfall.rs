//! `SCL01xx`: where YAML is not YAML, or means something else than it seems to.

mod anchor;
pub(super) mod boolean_word;
mod bracket;
mod conflict_marker;
pub(super) mod dash;
mod depth;
mod directive;
pub(super) mod duplicate_key;
mod empty_file;
mod indentation;
mod invisible;
pub(super) mod leading_zero;
pub(super) mod look_alike;
pub(super) mod merge_key;
mod missing_colon;
mod missing_comma;
pub(super) mod missing_space;
pub(super) mod no_value;
mod not_yaml;
pub(super) mod number_name;
pub(super) mod odd_key;
mod quote;
mod repair;
mod reserved_character;
mod scan;
mod second_document;
mod tab;
mod tab_separator;
mod tag;
pub(super) mod text_block_name;
mod unexpected;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rule::Rule;
use crate::source::{FileId, SourceFile, Span};
use crate::yaml::{SyntaxError, SyntaxErrorKind, Tree};

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
    source: &'s SourceFile,
    file: FileId,
}

impl<'s> Place<'s> {
    pub(super) fn new(source: &'s SourceFile, file: FileId) -> Self {
        Place { source, file }
    }

    /// The span of some bytes of the file.
    fn span(&self, range: std::ops::Range<usize>) -> Span {
        Span { file: self.file, start: range.start as u32, end: range.end as u32 }
    }

    /// The line of a byte, from 1.
    fn line(&self, at: usize) -> u32 {
        self.source.line(at as u32)
    }

    /// The bytes of the line below one that ends at a byte, without the line break; at the end of the file, nothing.
    fn line_below(&self, end: usize) -> std::ops::Range<usize> {
        let text = self.source.text();
        let next = text[end..].find('\n').map_or(text.len(), |at| end + at + 1);
        self.line_range(next)
    }

    /// The bytes of the line of a byte, without the line break.
    fn line_range(&self, at: usize) -> std::ops::Range<usize> {
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
pub(super) fn check_tree(
    tree: &Tree,
    text: &CheckedText,
    source: &SourceFile,
    file: FileId,
    problems: &mut Diagnostics,
) {
    let place = Place { source, file };
    anchor::check(tree, &place, problems);
    problems.extend(tree.tags.iter().map(|tag| tag::diagnose(*tag)));
    problems.extend(tree.second_document.map(|at| second_document::diagnose(&place, at)));
    problems.extend(tree.too_deep.map(depth::diagnose));
    match &tree.error {
        Some(error) if error.kind == SyntaxErrorKind::Limit => {
            // The parser may notice it before it hands out the first of the nested values.
            let at = place.span(error.at..error.at);
            problems.extend(tree.too_deep.is_none().then(|| depth::diagnose(at)));
        }
        Some(error) => problems.extend(syntax_error(error, text, &place)),
        None => problems.extend(empty_file::find(tree, &place)),
    }
}

/// The rule that explains best why the parser stopped; none where a problem says so already.
fn syntax_error(error: &SyntaxError, text: &CheckedText, place: &Place<'_>) -> Option<Diagnostic> {
    if text.is_mended {
        return None;
    }
    let explained = match error.kind {
        SyntaxErrorKind::Glued => missing_space::at_bracket(error, &text.text, place),
        SyntaxErrorKind::Quote => quote::find(error, &text.text, place),
        SyntaxErrorKind::Character(character) => Some(reserved_character::diagnose(error.at, character, place)),
        SyntaxErrorKind::Property => reserved_character::find(error.at, place),
        SyntaxErrorKind::Tab => Some(tab::elsewhere(error.at, place)),
        SyntaxErrorKind::Directive => Some(directive::diagnose(place, error.at)),
        _ => None,
    };
    let explained =
        explained.or_else(|| missing_space::before(error, place)).or_else(|| quote::find(error, &text.text, place));
    if explained.is_some() {
        return explained;
    }
    let repair = repair::find(error, text, place);
    if repair.as_ref().is_some_and(|repair| repair.is_sure) {
        return repair.map(|repair| repair.problem);
    }
    bracket::find(error, &text.text, place)
        .or_else(|| not_yaml::missing_dash_space(error, place))
        .or_else(|| not_yaml::missing_colon(error, place))
        .or_else(|| indentation::find(error, &text.text, place))
        .or_else(|| repair.map(|repair| repair.problem))
        .or_else(|| Some(not_yaml::diagnose(error, place)))
}
