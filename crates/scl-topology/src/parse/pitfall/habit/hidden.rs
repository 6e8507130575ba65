//! An item of a list in brackets with a `#` before it, which hides the closing bracket.

use super::{Way, reads_further};
use crate::diagnostic::{Diagnostic, Edit};
use crate::parse::dialect::Dialect;
use crate::parse::pitfall::{bracket, scan};
use crate::source::SourceFile;
use crate::yaml::SyntaxError;

/// The `#` in the line of the innermost bracket that is open at a syntax error.
pub(in crate::parse) fn find(
    error: &SyntaxError,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Diagnostic> {
    let open = scan::scan(text.get(..error.at)?).open_brackets.pop()?;
    let line = source.line_range(open);
    let rest = text.get(open..line.end)?.trim_end();
    let is_hash = |at: &usize| rest[..*at].ends_with([' ', ',', '[', '{']) && !rest[at + 1..].starts_with([' ', '#']);
    let at = rest.match_indices('#').map(|(at, _)| at).find(is_hash)?;
    let item = rest[at + 1..].trim_end_matches([']', '}', ',']);
    let closing = rest[at + 1..][item.len()..].trim_end_matches(',');
    if item.is_empty() || closing.is_empty() {
        return None;
    }
    let hash = open + at;
    let before = open + rest[..at].trim_end_matches([' ', ',']).len();
    let end = hash + 1 + item.len();
    let (list, written) = (&text[open..before], &text[open..open + 1]);
    let ways = [
        Way {
            help: format!("if `{item}` belongs to the list, remove `#`"),
            changes: vec![(hash..hash + 1, String::new())],
        },
        Way {
            help: format!("if it is a comment, write `{list}{closing} # {item}`"),
            changes: vec![(before..hash + 1, format!("{closing} # ")), (end..end + closing.len(), String::new())],
        },
    ];
    if !ways.iter().any(|way| reads_further(way, error, text, source, dialect)) {
        return None;
    }
    let problem = bracket::RULE
        .at(
            format!("this `#` starts a comment, so `{closing}` behind it closes nothing"),
            source.span(hash..hash + 1),
            "the rest of the line is not read",
        )
        .label(source.span(open..open + 1), format!("this `{written}` is never closed"));
    Some(ways.into_iter().fold(problem, |problem, way| {
        problem.suggest(way.help, way.changes.into_iter().map(|(at, with)| Edit::new(source.span(at), with)))
    }))
}
