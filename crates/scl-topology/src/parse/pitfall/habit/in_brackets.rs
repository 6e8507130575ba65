//! What other notations put in brackets behind or around a name: the number of an element, a link.

use super::{Found, Way, line_list, lines};
use crate::source::SourceFile;
use std::ops::Range;

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
    Some(Found {
        message: format!("`{}` is not a name: names have no brackets", &text[start..first.end]),
        at: first,
        label: "there are no arrays",
        ways: vec![way(""), way("_"), way("-")],
        is_certain: true,
        otherwise: Some("each component and each gate has a name of its own"),
    })
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
