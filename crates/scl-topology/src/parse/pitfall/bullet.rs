//! Lists whose items begin with another mark than `-`, as in Markdown or in a word processor.

use super::habit::{line_list, lines};
use super::scan::Scan;
use super::{dash, look_alike};
use crate::confusable;
use crate::diagnostic::{Diagnostics, Edit};
use crate::parse::dialect::Dialect;
use crate::source::SourceFile;

/// Reports the marks of all items if a list begins with one of them. Returns true if there are any: then the rest of
/// the file means nothing.
pub(super) fn check(source: &SourceFile, scan: &Scan, dialect: &Dialect, problems: &mut Diagnostics) -> bool {
    let text = source.text();
    let mut found = Vec::new();
    let mut is_list = false;
    let mut is_head = false;
    // The column of the key whose text block goes on.
    let mut block = None;
    for (start, line) in lines(text) {
        let content = line.trim();
        let indent = line.len() - line.trim_start().len();
        if content.is_empty() || content.starts_with('#') || block.is_some_and(|column| indent > column) {
            continue;
        }
        block = [": |", ": >", ": |-", ": >-"].iter().any(|end| content.ends_with(end)).then_some(indent);
        let at = start + indent;
        if let Some(mark) = mark(content).filter(|_| !scan.is_free_text(at)) {
            is_list |= is_head;
            found.push((at, mark));
        }
        let key = content.trim_start_matches(|letter: char| !letter.is_alphanumeric()).strip_suffix(':');
        is_head = key.is_some_and(dialect.is_key);
    }
    let Some(&(first, mark)) = found.first().filter(|_| is_list) else { return false };
    let end = first + mark.len_utf8();
    let problem = match mark.is_ascii() {
        true => dash::other_mark(first, source),
        false => look_alike::diagnose(&(first..end), dash_for(end, text), source),
    };
    let later: Vec<usize> = found.iter().skip(1).map(|(at, _)| *at).collect();
    let problem = match later.is_empty() {
        true => problem,
        false => problem.extend_help(&format!(", and the same on {}", line_list(&later, source))),
    };
    let edits = found.iter().map(|(at, mark)| {
        let end = at + mark.len_utf8();
        Edit::new(source.span(*at..end), dash_for(end, text))
    });
    problems.push(problem.carry(edits.collect(), true));
    true
}

/// The dash for a mark that ends at a place.
fn dash_for(end: usize, text: &str) -> &'static str {
    let is_glued = text.get(end..).is_some_and(|rest| !rest.starts_with([' ', '\n', '\r']));
    if is_glued { "- " } else { "-" }
}

/// The mark in the place of the dash of an item.
fn mark(content: &str) -> Option<char> {
    let first = content.chars().next()?;
    let rest = content.get(first.len_utf8()..)?;
    let is_mark = match first {
        '*' | '+' => rest.starts_with(' '),
        _ => confusable::mark(first).is_some_and(|(_, mark)| mark == "-"),
    };
    let rest = rest.trim_start();
    let is_item = rest.starts_with(['[', '{']) || rest.split(' ').next().is_some_and(|word| word.ends_with(':'));
    (is_mark && (is_item || !rest.contains(' '))).then_some(first)
}

#[cfg(test)]
mod tests {
    use crate::advice::apply;
    use crate::parse::testing::{headlines, parse_text};

    const SOUND: &str = "components:\n  - name: a\n    doc: |\n      * see: b\n    gates:\n      - x: {pub: T}\n\
                         \x20     - y: {pub: T}\n  - name: b\n    gates:\n      - x: {sub: T, queue: 1}\n\
                         connections:\n  - [a.x, b.x]\n";

    #[test]
    fn all_items_get_their_dash() {
        assert_eq!(headlines(SOUND), "");
        for (dash, mark) in [
            ("  - name", "  * name"),
            ("  - name", "  – name"),
            ("  - name", "  –name"),
            ("      - ", "      • "),
            ("      - ", "      + "),
            ("  - [", "* ["),
            ("- ", "— "),
        ] {
            let wrong = SOUND.replace(dash, mark);
            let (_, problems, _) = parse_text(&wrong);
            assert_eq!(problems.len(), 1, "{wrong}\n{problems:?}");
            let edits: Vec<_> = problems[0].proposals().next().iter().flat_map(|way| &way.edits).collect();
            let mended = apply(&wrong, &edits).unwrap_or_default();
            assert!(!edits.is_empty() && headlines(&mended).is_empty(), "{wrong}\n{mended}");
        }
    }
}
