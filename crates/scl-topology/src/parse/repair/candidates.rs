//! The changes to one line that are tried.

mod colons;
mod columns;

use super::line::{Class, Token, tokens};
use super::{Edit, Kind, quoting};
use crate::parse::dialect::Dialect;
use crate::parse::pitfall::look_alike;
use crate::parse::words::COMPONENT_KEYS;
use crate::source::SourceFile;
use std::ops::Range;

/// Number of lines above a line that are searched for the columns in use.
const MOST_ABOVE: usize = 40;

pub(super) fn of_line(line: &Range<usize>, text: &str, source: &SourceFile, dialect: &Dialect) -> Vec<Edit> {
    let (tokens, open_after) = tokens(line, text);
    let mut edits = Vec::new();
    look_alikes(line, text, &mut edits);
    glued_colons(&tokens, text, &mut edits);
    for at in 0..tokens.len() {
        let next = tokens.get(at + 1);
        between(&tokens, at, next, text, &mut edits);
        marks(&tokens[at], next, text, &mut edits);
    }
    if let Some(last) = tokens.last() {
        at_end(last, &open_after, line, text, dialect, &mut edits);
    }
    surplus(&tokens, line, text, &mut edits);
    second_key(&tokens, line, text, dialect, &mut edits);
    colons::braces(&tokens, line, text, dialect, &mut edits);
    colons::second(&tokens, text, &mut edits);
    odd_colon(&tokens, text, dialect, &mut edits);
    parentheses(&tokens, text, &mut edits);
    quotes(line, text, &mut edits);
    first_of_line(&tokens, line, text, &mut edits);
    other_mark(&tokens, text, &mut edits);
    dash(&tokens, line, text, &mut edits);
    columns::columns(&tokens, line, text, source, &mut edits);
    edits.extend(quoting::of_line(line, text, dialect));
    edits
}

fn edit(kind: Kind, range: Range<usize>, with: impl Into<String>, cost: usize) -> Edit {
    Edit { kind, changes: vec![(range, with.into())], cost }
}

/// Characters that look like marks of YAML, all of a line at once.
fn look_alikes(line: &Range<usize>, text: &str, edits: &mut Vec<Edit>) {
    let found: Vec<(usize, char, &str)> = look_alike::marks(&text[line.clone()]).collect();
    let Some((first, mark, _)) = found.first() else { return };
    let first = line.start + first..line.start + first + mark.len_utf8();
    let changes = found.iter().map(|(at, mark, meant)| {
        let range = line.start + at..line.start + at + mark.len_utf8();
        let is_glued = !text[range.end..].starts_with([' ', '\n', '\r']);
        let space = if matches!(*meant, ":" | "," | "-") && is_glued { " " } else { "" };
        (range, format!("{meant}{space}"))
    });
    edits.push(Edit { kind: Kind::LookAlike(first), changes: changes.collect(), cost: 0 });
}

/// Colons in brackets without a space after them, all of a line at once.
fn glued_colons(tokens: &[Token], text: &str, edits: &mut Vec<Edit>) {
    let is_glued = |pair: &&[Token]| {
        pair[0].class == Class::Colon && pair[0].range.end == pair[1].range.start && !pair[0].open.is_empty()
    };
    let glued: Vec<&[Token]> = tokens.windows(2).filter(is_glued).collect();
    let Some(first) = glued.first() else { return };
    let start = text[..first[0].range.start].rfind([' ', '{', '[', ',', '\n']).map_or(0, |at| at + 1);
    let kind = Kind::Space(start..first[1].range.end);
    let changes = glued.iter().map(|pair| (pair[0].range.end..pair[0].range.end, " ".to_owned()));
    edits.push(Edit { kind, changes: changes.collect(), cost: 0 });
}

/// Proposes what may be missing after a token.
fn between(tokens: &[Token], at: usize, next: Option<&Token>, text: &str, edits: &mut Vec<Edit>) {
    let token = &tokens[at];
    let end = token.range.end;
    let open = next.map_or(&[][..], |next| &next.open);
    if let Some(next) = next {
        // A kind without a type, as in `pub:`, ends with its colon.
        let ends = token.ends_value() || token.class == Class::Colon && next.class == Class::Word;
        if !open.is_empty() && ends && next.begins_value() {
            let space = if next.range.start == end { ", " } else { "," };
            edits.push(edit(Kind::Comma(token.range.clone(), next.range.clone()), end..end, space, 1));
        }
        let ends = matches!(next.class, Class::Comma | Class::Close);
        if !open.is_empty() && (token.ends_value() || token.class == Class::Colon) && ends {
            close(open, token, text, 1, edits);
        }
        // A key is the first word in its line, or follows an opening bracket or a comma.
        let is_first = tokens[..at].iter().all(|before| before.class == Class::Dash);
        let follows = at.checked_sub(1).is_some_and(|at| matches!(tokens[at].class, Class::Open | Class::Comma));
        if token.class == Class::Word && (is_first || follows) && next.begins_value() {
            let space = if next.range.start == end { ": " } else { ":" };
            edits.push(edit(Kind::Colon(token.range.clone()), end..end, space, 1));
        }
    }
    if token.class == Class::Word && !tokens[..at].iter().any(|before| before.class == Class::Close) {
        let before = token.range.start;
        for (bracket, closing) in [("[", b']'), ("{", b'}')] {
            let closer = tokens[at..].iter().find(|other| text.as_bytes()[other.range.start] == closing);
            if let Some(closer) = closer {
                let kind = Kind::Open(closer.range.start, token.range.clone());
                edits.push(edit(kind, before..before, bracket, 2));
            }
        }
    }
}

/// Proposes the bracket that closes the innermost open one.
fn close(open: &[usize], after: &Token, text: &str, cost: usize, edits: &mut Vec<Edit>) {
    let Some(&last) = open.last() else { return };
    let bracket = if text[last..].starts_with('[') { "]" } else { "}" };
    let end = after.range.end;
    edits.push(edit(Kind::Close(last, after.range.clone()), end..end, bracket, cost));
}

/// Proposes corrections of a mark.
fn marks(token: &Token, next: Option<&Token>, text: &str, edits: &mut Vec<Edit>) {
    let range = token.range.clone();
    let word = &text[range.clone()];
    let mut instead = |other: &str| {
        let kind = Kind::Instead(range.clone(), other.trim().chars().next().unwrap_or(' '));
        edits.push(edit(kind, range.clone(), other, 1));
    };
    match (token.class, word) {
        (Class::Other, ";") => instead(","),
        (Class::Other, "=") => {
            let is_glued = next.is_some_and(|next| next.range.start == range.end);
            let start = text[..range.start].trim_end_matches(' ').len();
            let with = if is_glued { ": " } else { ":" };
            edits.push(edit(Kind::Instead(range.clone(), ':'), start..range.end, with, 1));
        }
        (Class::Close, found) => {
            let other = if found == "]" { "}" } else { "]" };
            if let Some(&open) = token.open.last() {
                edits.push(edit(Kind::Partner(open, range.start), range.clone(), other, 1));
            }
        }
        (Class::Open, found) => {
            let inside = text[range.end..].find([']', '}', '\n']).map(|at| range.end + at);
            if let Some(close) = inside.filter(|at| !text[*at..].starts_with('\n')) {
                let other = if found == "[" { "{" } else { "[" };
                edits.push(edit(Kind::Partner(range.start, close), range.clone(), other, 1));
            }
        }
        (Class::Quote, _) => edits.push(edit(Kind::Quote(range.start), range.clone(), "", 1)),
        (Class::Word, word) if word.starts_with('-') && (word.len() > 1 || is_followed(next, &range)) => {
            let dash = range.start..range.start + 1;
            edits.push(edit(Kind::DashSpace(dash), range.start + 1..range.start + 1, " ", 1));
        }
        (Class::Word, word) if word.contains('#') => {
            let hash = range.start + word.find('#').unwrap_or(0);
            edits.push(edit(Kind::CommentSpace(hash), hash..hash, " ", 1));
        }
        _ => {}
    }
    if let Some(dash) = next.filter(|next| next.class == Class::Dash && token.class != Class::Dash) {
        let start = text[..range.start].rfind('\n').map_or(0, |at| at + 1);
        let indent: String = text[start..].chars().take_while(|letter| *letter == ' ').collect();
        let before = range.end..dash.range.start;
        edits.push(edit(Kind::Break(dash.range.start), before, format!("\n{indent}"), 2));
    }
}

/// Whether a token that begins a value follows without a space.
fn is_followed(next: Option<&Token>, range: &Range<usize>) -> bool {
    next.is_some_and(|next| next.range.start == range.end && next.begins_value())
}

/// Proposes what may be missing at the end of a line: a comma before the next, a bracket, the colon of a known key.
fn at_end(last: &Token, open: &[usize], line: &Range<usize>, text: &str, dialect: &Dialect, edits: &mut Vec<Edit>) {
    let end = last.range.end;
    if open.is_empty() && last.class == Class::Word {
        let word = &text[last.range.clone()];
        if (dialect.is_key)(word) {
            edits.push(edit(Kind::Colon(last.range.clone()), end..end, ":", 0));
        }
    }
    if last.class == Class::Colon && !open.is_empty() {
        edits.push(edit(Kind::OpenAfter(last.range.clone()), end..end, " [", 2));
    }
    let after = if last.class == Class::Comma { last.range.start } else { end };
    let below = text[line.end..].trim_start();
    if !open.is_empty() && last.ends_value() && !below.starts_with([',', ']', '}', '#']) && !below.is_empty() {
        let start = text.len() - below.len();
        let length = below.find([' ', ':', ',', '\n']).unwrap_or(below.len()).max(1);
        let is_bracket = below.starts_with(['[', '{']);
        let next = start..start + if is_bracket { 1 } else { length };
        edits.push(edit(Kind::Comma(last.range.clone(), next), end..end, ",", 1));
    }
    if let Some(&innermost) = open.last() {
        let bracket = if text[innermost..].starts_with('[') { "]" } else { "}" };
        let before = text[..after].trim_end().len();
        let start = text[..before].rfind([' ', '[', '{', ',']).map_or(0, |at| at + 1);
        let kind = Kind::Close(innermost, start.min(before)..before);
        edits.push(edit(kind.clone(), before..before, bracket, 1));
        if last.class == Class::Comma {
            edits.push(edit(kind, last.range.clone(), bracket, 1));
        }
    }
}

/// Proposes to remove what may be too much: a mark, a word, or all that follows a value.
fn surplus(tokens: &[Token], line: &Range<usize>, text: &str, edits: &mut Vec<Edit>) {
    for (at, token) in tokens.iter().enumerate() {
        let range = token.range.clone();
        let word = &text[range.clone()];
        let is_glued = at.checked_sub(1).is_some_and(|at| tokens[at].range.end == range.start);
        let is_type = at > 1 && tokens[at - 1].class == Class::Word && tokens[at - 2].class == Class::Colon;
        if token.class == Class::Open && is_glued && is_type {
            let close = tokens[at..].iter().find(|other| other.class == Class::Close).map(|close| close.range.end);
            if let Some(end) = close {
                let all = tokens[at - 1].range.start..end;
                edits.push(edit(Kind::ArrayType(all), range.start..end, "", 1));
            }
        }
        if word == "::" {
            let second = range.start + 1..range.end;
            edits.push(edit(Kind::Surplus(second.clone()), second, "", 1));
        }
        match token.class {
            Class::Word if word == "-" => edits.push(edit(Kind::Surplus(range.clone()), range, "", 1)),
            Class::Word => edits.push(edit(Kind::Surplus(range.clone()), range, "", 4)),
            Class::Quote => {}
            Class::Close => edits.push(edit(Kind::Surplus(range.clone()), range, "", 1)),
            _ => edits.push(edit(Kind::Surplus(range.clone()), range, "", 2)),
        }
        let is_second = word == ":" && tokens[..at].iter().any(|before| before.class == Class::Colon);
        let follows = at > 0 && tokens[at - 1].ends_value() && (word != ":" || is_second);
        if token.open.is_empty() && follows && at + 1 < tokens.len() {
            let rest = token.range.start..text[line.clone()].trim_end().len() + line.start;
            edits.push(edit(Kind::Surplus(rest.clone()), rest, "", 3));
        }
    }
}

/// Proposes braces or brackets in place of parentheses.
fn parentheses(tokens: &[Token], text: &str, edits: &mut Vec<Edit>) {
    let is = |token: &&Token, mark: &str| &text[token.range.clone()] == mark;
    let open = tokens.iter().find(|token| is(token, "("));
    let close = tokens.iter().rfind(|token| is(token, ")"));
    let (Some(open), Some(close)) = (open, close) else { return };
    for (left, right) in [("{", "}"), ("[", "]")] {
        let kind = Kind::Parentheses(open.range.clone());
        let changes = vec![(open.range.clone(), left.to_owned()), (close.range.clone(), right.to_owned())];
        edits.push(Edit { kind, changes, cost: 1 });
    }
}

/// Proposes to move a known key, in the line of another key, to a line of its own.
fn second_key(tokens: &[Token], line: &Range<usize>, text: &str, dialect: &Dialect, edits: &mut Vec<Edit>) {
    for at in 2..tokens.len().saturating_sub(1) {
        let [before, key, colon] = [&tokens[at - 1], &tokens[at], &tokens[at + 1]];
        let is_key = colon.class == Class::Colon && (dialect.word)(&text[key.range.clone()]).is_some();
        if is_key && key.open.is_empty() && before.ends_value() && before.range.end < key.range.start {
            let content = &text[line.clone()];
            let indent = content.len() - content.trim_start_matches([' ', '-']).len();
            let rest = key.range.start..line.start + content.trim_end().len();
            let gap = before.range.end..key.range.start;
            edits.push(edit(Kind::Key(rest), gap, format!("\n{}", " ".repeat(indent)), 1));
        }
    }
}

/// Proposes a colon in place of another character behind a known key.
fn odd_colon(tokens: &[Token], text: &str, dialect: &Dialect, edits: &mut Vec<Edit>) {
    for (at, token) in tokens.iter().enumerate() {
        let is_first = tokens[..at].iter().all(|before| before.class == Class::Dash);
        let follows = at > 0 && matches!(tokens[at - 1].class, Class::Open | Class::Comma);
        let word = &text[token.range.clone()];
        let Some(last) = word.chars().next_back().filter(|_| is_first || follows) else { continue };
        let mark = match tokens.get(at + 1) {
            _ if !last.is_ascii_alphanumeric() => token.range.end - last.len_utf8()..token.range.end,
            Some(next) if next.class == Class::Other && next.range.start == token.range.end => next.range.clone(),
            _ => continue,
        };
        if (dialect.word)(&text[token.range.start..mark.start]).is_some() {
            let space = if text[mark.end..].starts_with([' ', '\n', '\r']) { ":" } else { ": " };
            edits.push(edit(Kind::Instead(mark.clone(), ':'), mark, space, 0));
        }
    }
}

/// Proposes to add or remove a quote, in a line with an odd number of them.
fn quotes(line: &Range<usize>, text: &str, edits: &mut Vec<Edit>) {
    let content = &text[line.clone()];
    if content.matches('"').count().is_multiple_of(2) {
        return;
    }
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'-');
    let bytes = content.as_bytes();
    for at in 0..bytes.len() {
        let offset = line.start + at;
        if bytes[at] == b'"' {
            edits.push(edit(Kind::Quote(offset), offset..offset + 1, "", 2));
        }
        let starts = is_word(bytes[at]) && (at == 0 || !is_word(bytes[at - 1]) && bytes[at - 1] != b'"');
        let ends = is_word(bytes[at]) && bytes.get(at + 1).is_none_or(|next| !is_word(*next) && *next != b'"');
        for (is_edge, edge) in [(starts, offset), (ends, offset + 1)] {
            if is_edge {
                edits.push(edit(Kind::Unquoted(edge), edge..edge, "\"", 1));
            }
        }
    }
}

/// Proposes what may be missing before a line: a bracket before a comma, the name of the component whose keys these
/// are.
fn first_of_line(tokens: &[Token], line: &Range<usize>, text: &str, edits: &mut Vec<Edit>) {
    let Some(first) = tokens.first() else { return };
    let above = text[..line.start].trim_end();
    if let (Class::Comma | Class::Close, Some(&open)) = (first.class, first.open.last()) {
        let bracket = if text[open..].starts_with('[') { "]" } else { "}" };
        let last = above.char_indices().next_back().map_or(0, |(at, _)| at);
        edits.push(edit(Kind::Close(open, last..above.len()), first.range.start..first.range.start, bracket, 1));
    }
    let indent = first.range.start - line.start;
    let is_key = COMPONENT_KEYS.contains(&&text[first.range.clone()]);
    if is_key && indent > 1 && above.ends_with("components:") {
        let name = format!("{}- name: name\n", " ".repeat(indent - 2));
        edits.push(edit(Kind::Nameless(first.range.clone()), line.start..line.start, name, 4));
    }
}

/// `+` or `*` as the mark of a list item.
fn other_mark(tokens: &[Token], text: &str, edits: &mut Vec<Edit>) {
    let Some([mark, item, ..]) = tokens.get(..2) else { return };
    if matches!(&text[mark.range.clone()], "+" | "*") && item.range.start > mark.range.end {
        edits.push(edit(Kind::OtherMark(mark.range.start), mark.range.clone(), "-", 1));
    }
}

/// Proposes the dash of a list item, in place of the two spaces before it, before it, or in the column of the item
/// above.
fn dash(tokens: &[Token], line: &Range<usize>, text: &str, edits: &mut Vec<Edit>) {
    let Some(first) = tokens.first().filter(|first| first.begins_value()) else { return };
    let start = first.range.start;
    let kind = Kind::Dash(start..text[line.clone()].trim_end().len() + line.start);
    if text[line.start..start].ends_with("  ") {
        edits.push(edit(kind.clone(), start - 2..start, "- ", 3));
    }
    edits.push(edit(kind.clone(), start..start, "- ", 3));
    let mut above = text[..line.start].lines().rev().take(MOST_ABOVE);
    if let Some(item) = above.find(|line| line.trim_start().starts_with("- ")) {
        let column = item.len() - item.trim_start().len();
        if text[start..].starts_with('-') && !text[start + 1..].starts_with(['-', '>']) {
            let kind = Kind::DashSpace(start..start + 1);
            edits.push(edit(kind, line.start..start + 1, format!("{}- ", " ".repeat(column)), 2));
        }
        edits.push(edit(kind, line.start..start, format!("{}- ", " ".repeat(column)), 3));
    }
}
