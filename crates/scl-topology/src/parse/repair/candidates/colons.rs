//! Two colons where one can be.

use super::super::line::{Class, Token};
use super::super::{Edit, Kind};
use super::edit;
use crate::parse::dialect::Dialect;
use std::ops::Range;

/// Proposes braces around a known key and its value that follow another key in the line: `x: pub: A`.
pub(super) fn braces(tokens: &[Token], line: &Range<usize>, text: &str, dialect: &Dialect, edits: &mut Vec<Edit>) {
    let first = tokens.iter().take_while(|token| token.class == Class::Dash).count();
    let Some([key, colon, inner, second, value, ..]) = tokens.get(first..) else { return };
    let classes = [key, colon, inner, second].map(|token| token.class);
    let is_spaced = inner.range.start > colon.range.end && value.range.start > second.range.end;
    let is_known = (dialect.word)(&text[inner.range.clone()]).is_some();
    let last = tokens.last().map_or(value.range.end, |token| token.range.end);
    if classes == [Class::Word, Class::Colon, Class::Word, Class::Colon] && is_spaced && is_known && key.open.is_empty()
    {
        let inside = inner.range.start..last.min(line.end);
        let changes = vec![(inside.start..inside.start, "{".to_owned()), (inside.end..inside.end, "}".to_owned())];
        edits.push(Edit { kind: Kind::Braces(inside), changes, cost: 1 });
    }
}

/// Proposes an arrow or a dot in place of a second colon in brackets, or to remove the word before it.
pub(super) fn second(tokens: &[Token], text: &str, edits: &mut Vec<Edit>) {
    for window in tokens.windows(5) {
        let [key, colon, word, second, value] = window else { continue };
        let classes = [colon, word, second, value].map(|token| token.class);
        if classes != [Class::Colon, Class::Word, Class::Colon, Class::Word] {
            continue;
        }
        let all = word.range.start..value.range.end;
        let kind = Kind::SecondColon(all.clone());
        let gap = second.range.start..value.range.start;
        // `priority: fifo: 80`
        if text[value.range.clone()].bytes().all(|byte| byte.is_ascii_digit()) {
            edits.push(edit(kind.clone(), gap.clone(), ":", 2));
        }
        if word.open.is_empty() {
            continue;
        }
        if matches!(&text[key.range.clone()], "req" | "rep") {
            edits.push(edit(kind.clone(), gap.clone(), " -> ", 1));
        }
        let is_full = text[value.range.clone()].contains(['.', ':']);
        edits.push(edit(kind.clone(), all.start..value.range.start, "", if is_full { 2 } else { 3 }));
        edits.push(edit(kind, gap, ".", if is_full { 3 } else { 2 }));
    }
}
