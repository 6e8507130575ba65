//! The problem that a change stands for.

use super::{Edit, Kind};
use crate::diagnostic::{Diagnostic, Edit as Replacement};
use crate::parse::dialect::Dialect;
use crate::parse::pitfall::habit::line_list;
use crate::parse::pitfall::{
    bracket, dash, indentation, look_alike, missing_mark, missing_space, needs_quotes, quote, unexpected,
};
use crate::parse::shape::nameless;
use crate::source::SourceFile;
use std::ops::Range;

/// The problem, with the change as its proposal, and the changes of the same kind in later lines. A name that is
/// missing is no proposal: nobody knows it.
pub(super) fn tell(
    edit: &Edit,
    later: &[Edit],
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
    is_meant: bool,
) -> Diagnostic {
    if let Kind::Text(value) = &edit.kind
        && let Some(problem) = needs_quotes::behind_mark(value, text, source)
    {
        return problem;
    }
    let problem = words(edit, text, source, dialect);
    if matches!(edit.kind, Kind::Nameless(_)) {
        return problem;
    }
    let starts: Vec<usize> = later.iter().filter_map(|edit| Some(edit.changes.first()?.0.start)).collect();
    let problem = match starts.is_empty() {
        true => problem,
        false => problem.extend_help(&format!(", and the same on {}", line_list(&starts, source))),
    };
    let changes = std::iter::once(edit).chain(later).flat_map(|edit| &edit.changes);
    let edits = changes.map(|(range, with)| Replacement::new(source.span(range.clone()), with));
    problem.carry(edits.collect(), is_meant)
}

fn words(edit: &Edit, text: &str, source: &SourceFile, dialect: &Dialect) -> Diagnostic {
    match &edit.kind {
        Kind::Comma(before, after) => missing_mark::comma_between(before, after, text, source),
        Kind::Colon(word) => missing_mark::colon_after(word, text, source),
        Kind::Close(open, word) => {
            let replaced = edit.changes.first().map_or("", |(range, _)| &text[range.clone()]);
            bracket::close_after(*open, word, replaced, text, source)
        }
        Kind::Parentheses(open) => {
            let brackets: Vec<&str> = edit.changes.iter().map(|(_, with)| with.as_str()).collect();
            bracket::parentheses(open, &brackets, source)
        }
        Kind::Key(rest) => unexpected::key_in_line(rest, text, source),
        Kind::Open(close, word) => bracket::open_before(*close, word, text, source),
        Kind::Partner(open, close) => {
            let at = edit.changes.first().map_or(*close, |(range, _)| range.start);
            bracket::mismatched(*open, *close, at, text, source)
        }
        Kind::Instead(range, ',') => missing_mark::instead_of_comma(range, text, source),
        Kind::Instead(range, _) => missing_mark::instead_of_colon(range, text, source),
        Kind::Surplus(range) => surplus(range, text, source),
        Kind::Braces(value) => bracket::braces(value, text, source),
        Kind::SecondColon(rest) => {
            unexpected::second_colon(rest, edit.changes.first().map_or("", |(_, with)| with), text, source)
        }
        Kind::ArrayType(range) => unexpected::brackets_after_type(range, text, source),
        Kind::Space(glued) => missing_space::in_brackets(glued, text, source, dialect),
        Kind::CommentSpace(hash) => unexpected::glued_comment(*hash, text, source),
        Kind::Break(dash) => unexpected::item_in_line(*dash, text, source),
        Kind::Dash(item) => dash::missing(item, text, source),
        Kind::OtherMark(at) => dash::other_mark(*at, source),
        Kind::DashSpace(mark) => dash::without_space(mark, text, source),
        Kind::Quote(at) => quote::alone(*at, text, source),
        Kind::Unquoted(at) => quote::missing(*at, text, source),
        Kind::OpenAfter(colon) => bracket::open_after(colon, text, source),
        Kind::Nameless(key) => nameless::above(source.span(key.clone())),
        Kind::Indent(word, column) => indentation::in_wrong_column(word, *column, text, source),
        Kind::Text(value) => needs_quotes::diagnose(value, text, source),
        Kind::LookAlike(mark) => {
            let with = edit.changes.first().map_or("", |(_, with)| with.as_str());
            look_alike::diagnose(mark, with, source)
        }
    }
}

fn surplus(range: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    match &text[range.clone()] {
        "-" => dash::surplus(range, text, source),
        "]" | "}" => bracket::never_opened(range.start, text, source),
        "[" | "{" => bracket::surplus(range.start, text, source),
        _ => unexpected::diagnose(range, text, source),
    }
}
