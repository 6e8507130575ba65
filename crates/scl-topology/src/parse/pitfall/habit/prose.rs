//! Lines of plain words: a comment without its `#`, or a text that is not indented.

use super::{Way, line_list, lines, reads_further};
use crate::diagnostic::{Diagnostic, Edit};
use crate::parse::dialect::Dialect;
use crate::parse::pitfall::{indentation, look_alike, needs_quotes, unexpected};
use crate::source::SourceFile;
use crate::yaml::SyntaxError;

/// Number of lines above an error, and below the first line of a text, that are searched.
const MOST_LINES: usize = 20;

/// The line of an error, or one of those right above it, if the parser can go on without it.
pub(in crate::parse) fn find(
    error: &SyntaxError,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Diagnostic> {
    let here = source.line_range(error.at.min(text.len()));
    let mut above = lines_up(text, here.start).take(2).map(|(start, _)| start);
    let is_found = |start: &usize| is_prose(&text[source.line_range(*start)], dialect);
    let last = Some(here.start).filter(is_found).or_else(|| above.find(is_found))?;
    let before = lines_up(text, last).take(MOST_LINES).take_while(|(_, line)| is_prose(line, dialect)).last();
    let first = before.map_or(last, |(start, _)| start);
    let starts: Vec<usize> = lines(&text[first..])
        .map(|(start, line)| (first + start, line))
        .take_while(|(_, line)| is_prose(line, dialect))
        .take(MOST_LINES)
        .map(|(start, line)| start + line.len() - line.trim_start().len())
        .collect();
    let marked = starts.iter().map(|at| (*at..*at, "# ".to_owned())).collect();
    let line = source.line_range(first);
    let content = text[line.clone()].trim();
    let comment = match starts.as_slice() {
        [_] => format!("if it is a comment, write `# {content}`"),
        _ => format!("if they are comments, write `# ` before {}", line_list(&starts, source)),
    };
    let way = Way { help: comment, changes: marked };
    if !reads_further(&way, error, text, source, dialect) {
        return None;
    }
    let label = "plain words are allowed in texts and in comments";
    let problem = unexpected::RULE.at(
        "this line is neither a key nor a list item",
        source.span(line.start + text[line.clone()].len() - text[line.clone()].trim_start().len()..line.end),
        label,
    );
    let (_, key) = lines_up(text, first).next().unwrap_or((0, ""));
    let problem = match key_of_text(key) {
        Some(column) => problem.suggest(
            format!("if it belongs to the text above, indent it by {} spaces", column + 2),
            starts.iter().map(|at| indented(*at, column + 2, source)),
        ),
        None => problem,
    };
    let marked = way.changes.into_iter().map(|(at, with)| Edit::new(source.span(at), with));
    Some(problem.suggest(way.help, marked).otherwise("if it is a comment, write `# ` before it"))
}

/// Lines below a `|` or `>` that are not indented deeper than its key.
pub(in crate::parse) fn shallow_block(
    error: &SyntaxError,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Diagnostic> {
    let line = source.line_range(error.at.min(text.len()));
    let mut above = lines_up(text, line.start).take(MOST_LINES);
    let (head, header) =
        above.find(|(_, line)| [" |", " >", " |-", " >-"].iter().any(|end| line.trim_end().ends_with(end)))?;
    let column = key_of_text(header)?;
    let from = source.line_range(head).end + 1;
    let is_text = |line: &str| {
        let content = line.trim();
        let word = content.split([':', ' ']).next().unwrap_or("");
        let is_key = content[word.len()..].starts_with(':') && (dialect.is_key)(word);
        !content.is_empty() && !content.starts_with("- ") && !is_key
    };
    let below = lines(text.get(from..)?).take(MOST_LINES).take_while(|(_, line)| is_text(line));
    let found: Vec<(usize, &str)> = below.map(|(start, line)| (from + start, line)).collect();
    let (first, shown) = *found.first()?;
    if shown.len() - shown.trim_start().len() > column {
        return None;
    }
    let content = |(start, line): &(usize, &str)| start + line.len() - line.trim_start().len();
    let starts: Vec<usize> = found.iter().map(content).collect();
    let changes = starts.iter().map(|at| (source.line_range(*at).start..*at, " ".repeat(column + 2))).collect();
    let way = Way { help: format!("indent {} by {} spaces", line_list(&starts, source), column + 2), changes };
    let mark = header.trim_end().len() + head;
    let at = content(&(first, shown));
    reads_further(&way, error, text, source, dialect).then(|| {
        indentation::RULE
            .at(
                "the lines of a text are indented deeper than its key",
                source.span(at..source.line_range(at).end),
                "not deeper",
            )
            .label(source.span(mark - 1..mark), "the text begins on the next line")
            .propose(way.help, way.changes.into_iter().map(|(at, with)| Edit::new(source.span(at), with)))
    })
}

fn indented(at: usize, column: usize, source: &SourceFile) -> Edit {
    Edit::new(source.span(source.line_range(at).start..at), " ".repeat(column))
}

/// The column of the key of a text in its line.
fn key_of_text(line: &str) -> Option<usize> {
    let key = line.trim_start_matches([' ', '-']);
    let is_text = key.strip_prefix(needs_quotes::KEY).is_some_and(|rest| rest.starts_with(": "));
    is_text.then(|| line.len() - key.len())
}

/// Whether a line has only words in it, at least two, of which the first is none of the format. A number may stand
/// before them: the page on which a copied file was printed.
fn is_prose(line: &str, dialect: &Dialect) -> bool {
    let mut words = line.split_whitespace().skip_while(|word| word.bytes().all(|byte| byte.is_ascii_digit()));
    let first = words.next().filter(|word| word.starts_with(char::is_alphabetic));
    let is_plain = !line.contains([':', '#', '[', ']', '{', '}', '=', '<', '>', '|', '"']);
    // `doc：The rover` is a key with a colon of another script.
    let is_key = look_alike::marks(line).any(|(_, _, mark)| mark == ":");
    first.is_some_and(|word| (dialect.word)(word).is_none()) && words.next().is_some() && is_plain && !is_key
}

/// The lines above a place that have something in them, the nearest first.
fn lines_up(text: &str, start: usize) -> impl Iterator<Item = (usize, &str)> {
    let mut end = start;
    std::iter::from_fn(move || {
        let before = text.get(..end)?.strip_suffix('\n')?;
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        end = start;
        Some((start, &before[start..]))
    })
    .filter(|(_, line)| !line.trim().is_empty())
}
