//! What other notations put in brackets behind or around a name: the number of an element, a link.

use super::{Found, Way, line_list, lines};
use crate::source::SourceFile;
use scl_text::list::quoted_list;
use std::ops::Range;

/// Maximum number of elements of an array that are declared one by one.
const MOST_ELEMENTS: usize = 16;

/// Names with a number in brackets, as `imu[0].accel`.
pub(super) fn indexes(text: &str, source: &SourceFile) -> Option<Found> {
    let in_line = |(start, line): (usize, &str)| -> Vec<Range<usize>> {
        let is_name = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-');
        let index = |(at, _): (usize, &str)| {
            let digits = line[at + 1..].len() - line[at + 1..].trim_start_matches(|c: char| c.is_ascii_digit()).len();
            let after = line[at + 1 + digits..].strip_prefix(']').filter(|_| digits > 0)?;
            let head = line[..at].trim_end_matches(is_name);
            // Behind a colon, it is a type.
            let is_end = head.ends_with(['[', ',', '.']) || head.ends_with("- ") || head.trim_end().ends_with(',');
            let ends = after.trim().is_empty() || after.starts_with(['.', ',', ']', ':', ' ']);
            (head.len() < at && is_end && ends).then(|| start + at..start + at + digits + 2)
        };
        line.match_indices('[').filter_map(index).collect()
    };
    let found: Vec<Range<usize>> = lines(text).flat_map(in_line).collect();
    let first = found.first()?.clone();
    let start = text[..first.start].rfind([' ', '[', ',', '.']).map_or(0, |at| at + 1);
    let name = &text[start..first.start];
    let number = &text[first.start + 1..first.end - 1];
    let more = more(found.iter(), source);
    let way = |mark: &str| Way {
        help: format!("write `{name}{mark}{number}`{more}"),
        changes: found.iter().map(|at| (at.clone(), format!("{mark}{}", &text[at.start + 1..at.end - 1]))).collect(),
    };
    let each = elements(&found, text, source);
    Some(Found {
        message: format!("`{}` is not a name: names have no brackets", &text[start..first.end]),
        at: first,
        label: "there are no arrays",
        ways: each.into_iter().chain([way(""), way("_"), way("-")]).collect(),
        is_certain: true,
        otherwise: Some("each component and each gate has a name of its own"),
    })
}

/// `- phase[3]: pub`, an array whose elements have connections: a declaration of each element.
fn elements(found: &[Range<usize>], text: &str, source: &SourceFile) -> Option<Way> {
    let number = |at: &Range<usize>| text[at.start + 1..at.end - 1].parse::<usize>().ok();
    let is_declaration = |at: &&Range<usize>| text[at.end..].starts_with(':');
    let array = found.iter().find(is_declaration)?;
    let count = number(array).filter(|count| (2..=MOST_ELEMENTS).contains(count))?;
    let name = text[..array.start].rsplit(' ').next()?;
    let is_element = |at: &Range<usize>| {
        text[..at.start].ends_with(&format!(".{name}")) && number(at).is_some_and(|number| number < count)
    };
    if found.len() < 2 || !found.iter().all(|at| at == array || is_element(at)) {
        return None;
    }
    let line = source.line_range(array.start);
    let (head, tail) = (&text[line.start..array.start], &text[array.end..line.end]);
    let entries: Vec<String> = (0..count).map(|at| format!("{head}_{at}{tail}")).collect();
    let names: Vec<String> = (0..count).map(|at| format!("{name}_{at}")).collect();
    let help = format!("declare each of them, and use these names: {}", quoted_list(&names));
    let changes = found.iter().map(|at| match at == array {
        true => (line.clone(), entries.join("\n")),
        false => (at.clone(), format!("_{}", &text[at.start + 1..at.end - 1])),
    });
    Some(Way { help, changes: changes.collect() })
}

/// Which other lines have the same mistake.
fn more<'f>(found: impl Iterator<Item = &'f Range<usize>>, source: &SourceFile) -> String {
    let mut lines: Vec<usize> = found.map(|at| source.line_range(at.start).start).collect();
    lines.dedup();
    match lines.get(1..) {
        Some(later) if !later.is_empty() => format!(", and the same on {}", line_list(later, source)),
        _ => String::new(),
    }
}

/// Names that a chat or an editor has made links of, as `[a.b](http://a.b)`.
pub(super) fn links(text: &str, source: &SourceFile) -> Option<Found> {
    let in_line = |(start, line): (usize, &str)| -> Vec<(Range<usize>, String)> {
        let link = |(at, _): (usize, &str)| {
            let name = line[..at].rsplit('[').next()?;
            let address = line[at + 2..].split(')').next()?;
            let (_, host) = address.split_once("://")?;
            let open = start + at - name.len() - 1;
            let end = start + at + 2 + address.len() + 1;
            (host.trim_end_matches('/') == name && end <= start + line.len()).then(|| (open..end, name.to_owned()))
        };
        line.match_indices("](").filter_map(link).collect()
    };
    let changes: Vec<_> = lines(text).flat_map(in_line).collect();
    let first = changes.first()?.0.clone();
    let line = source.line_range(first.start);
    let (mut entry, mut at) = (String::new(), line.start);
    for (link, name) in changes.iter().take_while(|(link, _)| link.end <= line.end) {
        entry.push_str(&text[at..link.start]);
        entry.push_str(name);
        at = link.end;
    }
    entry.push_str(&text[at..line.end]);
    let help = format!("write `{}`{}", entry.trim(), more(changes.iter().map(|(at, _)| at), source));
    Some(Found {
        at: first,
        message: "this is a link in Markdown, not a name".to_owned(),
        label: "made of the name by a program",
        ways: vec![Way { help, changes }],
        is_certain: true,
        otherwise: None,
    })
}
