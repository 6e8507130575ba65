//! Marks of template engines, of shells that continue a line, of HTML and of Git LFS.

use super::{RULE, lines};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit};
use crate::parse::pitfall::scan::{Scan, blank};
use crate::source::SourceFile;
use crate::yaml::SyntaxError;
use std::ops::Range;

/// What opens and closes a part of a template.
const MARKS: [(&str, &str); 3] = [("{{", "}}"), ("{%", "%}"), ("<%", "%>")];

/// Reports the first part of a template that stands for a value or a line, and replaces all of them by spaces. Returns
/// true if there are any.
pub(in crate::parse::pitfall) fn check(
    source: &SourceFile,
    scan: &Scan,
    text: &mut String,
    problems: &mut Diagnostics,
) -> bool {
    let found: Vec<Range<usize>> = MARKS.iter().flat_map(|(open, close)| parts(open, close, scan, text)).collect();
    let Some(first) = found.iter().min_by_key(|part| part.start).cloned() else { return false };
    let mark = &text[first.start..first.start + 2];
    let message = format!("`{mark}` belongs to a template, and this file is read as it is");
    problems.push(
        RULE.at(message, source.span(first), "not replaced by anything")
            .help("check the file that the template produces, or put the value itself here"),
    );
    blank(text, found);
    true
}

/// What opens and closes the name of something that another tool fills in.
const PLACEHOLDERS: [(&str, &str); 4] = [("${", "}"), ("$(", ")"), ("@", "@"), ("%", "%")];

/// Maximum length of such a name.
const LONGEST_NAME: usize = 64;

/// The first placeholder in a text, such as `${NAME}`, `$(arg name)`, `@NAME@` or `$NAME`.
pub(crate) fn placeholder(text: &str) -> Option<Range<usize>> {
    let is_inside = |letter: char| letter.is_ascii_alphanumeric() || "_-. :".contains(letter);
    let found = |(open, close): &(&str, &str)| {
        let start = text.find(open)?;
        let rest = &text[start + open.len()..];
        let length = rest.find(|letter| !is_inside(letter)).filter(|length| (1..=LONGEST_NAME).contains(length))?;
        // A name between the same marks is in capitals, unlike an address or a share.
        let is_name = open != close || !rest[..length].contains(|letter: char| letter.is_lowercase() || letter == ' ');
        (is_name && rest[length..].starts_with(close)).then(|| start..start + open.len() + length + close.len())
    };
    let variable = || {
        let start = text.find('$')?;
        let name = text[start + 1..].find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
        let end = name.map_or(text.len(), |length| start + 1 + length);
        text[start + 1..end].starts_with(|first: char| first.is_ascii_uppercase()).then_some(start..end)
    };
    PLACEHOLDERS.iter().filter_map(found).chain(variable()).min_by_key(|found| found.start)
}

/// What to do about a placeholder.
pub(crate) const FILL_IN: &str = "write the value itself here, or check the file in which the tool has filled it in";

/// The problem of a placeholder.
pub(in crate::parse) fn unfilled(at: Range<usize>, source: &SourceFile) -> Diagnostic {
    let written = &source.text()[at.clone()];
    let message = format!("`{written}` is a placeholder, and this file is read as it is");
    RULE.at(message, source.span(at), "not replaced by anything").help(FILL_IN)
}

/// A placeholder at the place of a syntax error.
pub(in crate::parse) fn at_error(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let line = source.line_range(error.at.min(text.len()));
    let start = text[line.start..error.at.min(line.end)].rfind(['$', '@', '%']).map_or(error.at, |at| line.start + at);
    [start, error.at].into_iter().find_map(|start| {
        let found = placeholder(text.get(start..line.end)?).filter(|found| found.start == 0)?;
        let at = start..start + found.end;
        (at.start..=at.end).contains(&error.at).then(|| unfilled(at, source))
    })
}

/// Longer lines are not searched, so that the time is linear.
const LONGEST_LINE: usize = 1000;

fn short_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    lines(text).filter(|(_, line)| line.len() <= LONGEST_LINE)
}

fn parts<'t>(open: &str, close: &str, scan: &Scan, text: &'t str) -> Vec<Range<usize>> {
    let starts_value = |before: &str| {
        before.trim().is_empty() || [": ", "- ", ", ", "[", "{"].iter().any(|mark| before.ends_with(mark))
    };
    let in_line = |(start, line): (usize, &'t str)| -> Vec<Range<usize>> {
        let places = line.match_indices(open).filter(|(at, _)| starts_value(&line[..*at]));
        let places = places.filter(|(at, _)| !scan.is_free_text(start + at));
        places.filter_map(|(at, _)| Some(start + at..start + at + line[at..].find(close)? + close.len())).collect()
    };
    short_lines(text).flat_map(in_line).collect()
}

/// Reports a backslash after a comma or a bracket at the end of a line, and replaces all of them by spaces.
pub(in crate::parse::pitfall) fn check_backslashes(
    source: &SourceFile,
    scan: &Scan,
    text: &mut String,
    problems: &mut Diagnostics,
) {
    let in_line = |(start, line): (usize, &str)| {
        let before = line.trim_end().strip_suffix('\\')?;
        before.trim_end_matches(' ').ends_with([',', '[', '{']).then_some(start + before.len())
    };
    let found: Vec<usize> = lines(text).filter_map(in_line).filter(|at| !scan.is_free_text(*at)).collect();
    let Some(&first) = found.first() else { return };
    problems.push(
        RULE.at("YAML has no `\\` to continue a line", source.span(first..first + 1), "read as part of a word")
            .propose(
                "remove it: in brackets, a line simply goes on",
                found.iter().map(|at| Edit::new(source.span(*at..at + 1), "")),
            ),
    );
    blank(text, found.into_iter().map(|at| at..at + 1));
}

/// The arrow as HTML writes it.
const ARROW: &str = "-&gt;";

/// Reports arrows between two types as HTML writes them, and replaces them by `->` and spaces.
pub(in crate::parse::pitfall) fn check_arrows(source: &SourceFile, text: &mut String, problems: &mut Diagnostics) {
    let is_between_types = |before: &str| {
        let mut words = before.split([' ', '{', ',']).rev().filter(|word| !word.is_empty());
        words.next().is_some() && matches!(words.next(), Some("req:" | "rep:"))
    };
    let in_line = |(start, line): (usize, &str)| -> Vec<usize> {
        let places = line.match_indices(ARROW).filter(|(at, _)| is_between_types(&line[..*at]));
        places.map(|(at, _)| start + at).collect()
    };
    let found: Vec<usize> = short_lines(text).flat_map(in_line).collect();
    let Some(&first) = found.first() else { return };
    problems.push(
        RULE.at(
            "`-&gt;` is `->` in HTML",
            source.span(first..first + ARROW.len()),
            "copied from the source of a web page",
        )
        .propose("write `->`", found.iter().map(|at| Edit::new(source.span(*at..at + ARROW.len()), "->"))),
    );
    for at in found {
        text.replace_range(at..at + ARROW.len(), "->   ");
    }
}

/// How a file starts that stands in for one in the storage of Git LFS.
const POINTER: &str = "version https://git-lfs.";

/// Reports a file that Git LFS has not fetched. Returns true if it is one.
pub(in crate::parse::pitfall) fn check_pointer(source: &SourceFile, problems: &mut Diagnostics) -> bool {
    if !source.text().starts_with(POINTER) {
        return false;
    }
    problems.push(
        RULE.at(
            "this is a pointer of Git LFS, not the file itself",
            source.span(source.line_range(0)),
            "not fetched yet",
        )
        .help("`git lfs pull` fetches the file"),
    );
    true
}
