//! Texts without quotes, or in the wrong ones.

use super::{DOUBTFUL, Edit, Kind};
use crate::parse::dialect::Dialect;
use crate::parse::pitfall::{needs_quotes, scan};
use std::ops::Range;

/// How many closing brackets of a line may be the one that ends the braces of a text.
const MOST_ENDS: usize = 3;

/// How many lines may continue a text.
const MOST_BELOW: usize = 20;

/// Changes of a text that may hide a missing mark rank behind those that add the mark.
const WITH_KEY: usize = 3;

/// Quotes around the text of a line, for each place at which it may end.
pub(super) fn of_line(line: &Range<usize>, text: &str, dialect: &Dialect) -> Vec<Edit> {
    let Some(start) = start_of_text(line, text) else { return Vec::new() };
    let in_brackets = !scan::scan(&text[..start]).open_brackets.is_empty();
    let rest = text[start..line.end].trim_end();
    let more = if in_brackets { 0 } else { lines_below(line, text) };
    let ends = match in_brackets {
        true => ends_in_brackets(rest, dialect),
        false if more > 0 => vec![more + line.end - start],
        false => ends_of_line(rest),
    };
    let texts = ends.into_iter().map(|end| text[start..start + end].trim_end());
    texts
        .filter(|text| needs_quotes::is_needed(text, in_brackets))
        .filter_map(|text| edit(start, text, dialect))
        .collect()
}

/// As [`of_line`], without those that a missing mark explains better.
pub(super) fn likely(line: &Range<usize>, text: &str, dialect: &Dialect) -> Vec<Edit> {
    of_line(line, text, dialect).into_iter().filter(|edit| edit.cost != WITH_KEY).collect()
}

fn edit(start: usize, written: &str, dialect: &Dialect) -> Option<Edit> {
    let quote = written.chars().next()?;
    // A quote that is only missing at the end is no reason for others.
    if matches!(quote, '"' | '\'') && written.matches(quote).count() == 1 {
        return None;
    }
    let mut words = written.split_whitespace().filter_map(|word| word.split_once(':'));
    let has_key = words.any(|(word, _)| (dialect.word)(word.trim_start_matches(['{', '['])).is_some());
    let closes_more = |open, close| written.matches(close).count() > written.matches(open).count();
    let cost = match () {
        _ if has_key => WITH_KEY,
        // The bracket may be one too many.
        _ if closes_more('{', '}') || closes_more('[', ']') => DOUBTFUL,
        _ if written.contains(" #") && !written.starts_with(['"', '\'']) => DOUBTFUL,
        _ => 1,
    };
    let range = start..start + written.len();
    let quoted = needs_quotes::quoted(written);
    (quoted != written).then(|| Edit { kind: Kind::Text(range.clone()), changes: vec![(range, quoted)], cost })
}

/// Where the value of the text's key starts in a line.
fn start_of_text(line: &Range<usize>, text: &str) -> Option<usize> {
    let content = &text[line.clone()];
    let is_key = |at: usize| {
        let before = &content[..at];
        let after = &content[at + needs_quotes::KEY.len()..];
        before.is_empty() || before.ends_with([' ', '{', ',']) && after.starts_with(": ") && !before.contains(" #")
    };
    let (at, _) = content.match_indices(needs_quotes::KEY).find(|(at, _)| is_key(*at))?;
    let value = content[at..].split_once(':')?.1.trim_start();
    (!value.trim_end().is_empty()).then(|| line.end - value.len())
}

/// The length of the lines below that continue a text: those that are indented deeper than its key.
fn lines_below(line: &Range<usize>, text: &str) -> usize {
    let indent_of = |line: &str| line.len() - line.trim_start_matches([' ', '-']).len();
    let indent = indent_of(&text[line.clone()]);
    let below = text[line.end..].strip_prefix('\n').unwrap_or("").split_inclusive('\n').take(MOST_BELOW);
    let is_text = |line: &&str| indent_of(line) > indent && !line.trim_start().starts_with(['-', '#']);
    let length: usize = below.take_while(is_text).map(str::len).sum();
    length + usize::from(length > 0)
}

fn ends_of_line(rest: &str) -> Vec<usize> {
    let comment = rest.find(" #");
    let is_quoted = rest.len() > 1 && rest.starts_with(['"', '\'']) && rest.ends_with(&rest[..1]);
    match comment {
        Some(comment) if is_quoted => vec![rest.len(), comment],
        Some(comment) => vec![comment],
        None => vec![rest.len()],
    }
}

/// Before the next key, before a closing bracket, or at the end of the line.
fn ends_in_brackets(rest: &str, dialect: &Dialect) -> Vec<usize> {
    let is_before_key = |at: usize| {
        let word = rest[at + 1..].trim_start().split(':').next().unwrap_or("");
        (dialect.word)(word).is_some()
    };
    let commas = rest.match_indices(',').map(|(at, _)| at);
    let mut ends: Vec<usize> = commas.clone().filter(|at| is_before_key(*at)).take(1).collect();
    ends.extend(rest.rmatch_indices(['}', ']']).map(|(at, _)| at).take(MOST_ENDS));
    ends.push(rest.trim_end_matches(',').len());
    ends
}
