//! The problem that a change stands for.

use super::{Edit, Kind};
use crate::diagnostic::Diagnostic;
use crate::parse::pitfall::{
    Place, bracket, dash, indentation, look_alike, missing_colon, missing_comma, missing_space, quote, unexpected,
};
use crate::parse::shape::nameless;
use std::ops::Range;

pub(super) fn tell(edit: &Edit, text: &str, place: &Place<'_>) -> Diagnostic {
    match &edit.kind {
        Kind::Comma(before, after) => missing_comma::between(before, after, text, place),
        Kind::Colon(word) => missing_colon::after(word, text, place),
        Kind::Close(open, word) => bracket::close_after(*open, word, text, place),
        Kind::Open(close, word) => bracket::open_before(*close, word, text, place),
        Kind::Partner(open, close) => bracket::mismatched(*open, *close, text, place),
        Kind::Instead(range, ',') => missing_comma::instead(range, text, place),
        Kind::Instead(range, _) => missing_colon::instead(range, text, place),
        Kind::Surplus(range) => surplus(range, text, place),
        Kind::ArrayType(range) => unexpected::brackets_after_type(range, text, place),
        Kind::Space(glued) => missing_space::in_brackets(glued, text, place),
        Kind::CommentSpace(hash) => unexpected::glued_comment(*hash, text, place),
        Kind::Break(dash) => unexpected::item_in_line(*dash, text, place),
        Kind::Dash(item) => dash::missing(item, text, place),
        Kind::OtherMark(at) => dash::other_mark(*at, place),
        Kind::DashSpace(mark) => dash::without_space(mark, text, place),
        Kind::Quote(at) => quote::alone(*at, text, place),
        Kind::Unquoted(at) => quote::missing(*at, text, place),
        Kind::OpenAfter(colon) => bracket::open_after(colon, text, place),
        Kind::Nameless(key) => nameless::above(place.span(key.clone())),
        Kind::Indent(word, column) => indentation::in_wrong_column(word, *column, text, place),
        Kind::LookAlike(mark) => look_alike::diagnose(mark, place),
    }
}

fn surplus(range: &Range<usize>, text: &str, place: &Place<'_>) -> Diagnostic {
    match &text[range.clone()] {
        "-" => dash::surplus(range, text, place),
        "]" | "}" => bracket::never_opened(range.start, text, place),
        "[" | "{" => bracket::never_closed(range.start, text, place),
        _ => unexpected::diagnose(range, text, place),
    }
}
