//! SCL0105: a line whose indentation fits no line above it.

use super::scan;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::words::COMPONENT_KEYS;
use crate::source::SourceFile;
use crate::yaml::{MAX_DEPTH, SyntaxError};
use std::ops::Range;

/// SCL0105.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0105",
    severity: Severity::Error,
    title: "inconsistent indentation",
    explanation: "YAML reads structure from indentation: all keys of a component start in the same column, and so do \
                  all items of a list. This line starts in a column that no line above it uses. Move it to the column \
                  that the message names.",
    example: " components:
   - name: sensor
-   gates:
+    gates:
       - measurements: pub
",
};

/// How far above an error its cause is looked for, in lines.
const MOST_ABOVE: usize = 64;

/// A column at which keys or list items stand, and the word that stood there first.
#[derive(Debug, Clone)]
struct Level {
    indent: usize,
    is_dash: bool,
    word: Range<usize>,
}

/// Checks the indentation of the line of a syntax error.
pub(in crate::parse) fn find(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let line = source.line_range(error.at.min(text.len()));
    let words = levels_of(&text[line.clone()], line.start);
    let first = words.first()?;
    let above = levels_above(text, line.start);
    if let Some(problem) = deeper_below(&line, text, source).or_else(|| fallen_out(&line, first.indent, text, source)) {
        return Some(problem);
    }
    if first.is_dash
        && let Some(problem) = first_of_list(first, &line, text, source)
    {
        return Some(problem);
    }
    if first.is_dash && above.iter().all(|level| level.indent < first.indent) {
        let key = above.last().filter(|level| has_value(level, text, source))?;
        // Inside a bracket, the line itself is wrong.
        if !scan::scan(text.get(line.start..error.at)?).open_brackets.is_empty() {
            return None;
        }
        return Some(list_without_key(first, key, text, source));
    }
    let item = above.iter().rev().find(|level| level.is_dash && first.is_dash);
    if let Some(item) = item.filter(|item| item.indent < first.indent) {
        return Some(uneven_items(first, item, "deeper", text, source));
    }
    let same = above.iter().find(|level| level.indent == first.indent);
    let is_misplaced_key = same.is_some_and(|level| level.is_dash) && !first.is_dash;
    if same.is_some() && !is_misplaced_key || error.at < first.word.start {
        return None;
    }
    let keys = above.iter().filter(|level| level.is_dash == first.is_dash);
    let meant = keys.min_by_key(|level| (level.indent.abs_diff(first.indent), std::cmp::Reverse(level.indent)))?;
    let moved = moved(&first.word, first.indent, meant.indent, text, source);
    let mut problem = diagnose(first, meant, is_misplaced_key, &above, text, source);
    let between = first.indent..meant.indent;
    if first.is_dash && above.iter().any(|level| !level.is_dash && between.contains(&level.indent)) {
        // It would become an item of another list.
        problem.clear_helps();
        return Some(problem.help(ONE_COLUMN));
    }
    Some(problem.carry(moved, false))
}

/// What holds for the items of every list.
const ONE_COLUMN: &str = "the items of one list stand in one column";

/// How many lines below a line move with it.
const MOST_BELOW: usize = 64;

/// The line of a word, and those below it that are indented deeper, in another column.
fn moved(word: &Range<usize>, from: usize, to: usize, text: &str, source: &SourceFile) -> Vec<Edit> {
    let start = source.line_range(word.start).start;
    let mut edits = Vec::new();
    let mut at = start;
    for line in text[start..].split_inclusive('\n').take(MOST_BELOW) {
        let indent = line.len() - line.trim_start_matches(' ').len();
        let is_blank = line.trim().is_empty();
        if at > start && !is_blank && indent <= from {
            break;
        }
        if !is_blank && to > from {
            edits.push(Edit::new(source.span(at..at), " ".repeat(to - from)));
        } else if !is_blank {
            edits.push(Edit::new(source.span(at..at + from - to), ""));
        }
        at += line.len();
    }
    edits
}

/// The items from one on that are indented deeper and deeper, all in one column.
fn aligned(item: &Level, column: usize, text: &str, source: &SourceFile) -> Vec<Edit> {
    let start = source.line_range(item.word.start).start;
    let mut edits = Vec::new();
    let mut at = start;
    for line in text[start..].split_inclusive('\n').take(MOST_BELOW) {
        let indent = line.len() - line.trim_start_matches(' ').len();
        if !line[indent..].starts_with("- ") || indent <= column {
            break;
        }
        edits.push(Edit::new(source.span(at..at + indent), " ".repeat(column)));
        at += line.len();
    }
    edits
}

/// A line, by its first word, that belongs in another column.
pub(in crate::parse) fn in_wrong_column(
    word: &Range<usize>,
    column: usize,
    text: &str,
    source: &SourceFile,
) -> Diagnostic {
    let line = source.line_range(word.start);
    let above = levels_above(text, line.start);
    let own = levels_of(&text[line.clone()], line.start).into_iter().next();
    let own = own.unwrap_or(Level { indent: word.start - line.start, is_dash: false, word: word.clone() });
    let meant = above.iter().rev().find(|level| level.indent == column && level.is_dash == own.is_dash);
    let same = above.iter().find(|level| level.indent == own.indent);
    let is_misplaced_key = same.is_some_and(|level| level.is_dash) && !own.is_dash && column > 0;
    if let Some(meant) = meant.filter(|_| same.is_none() || is_misplaced_key) {
        return diagnose(&own, meant, is_misplaced_key, &above, text, source);
    }
    let name = &text[own.word.clone()];
    let what = if own.is_dash { "this list item".to_owned() } else { format!("`{name}`") };
    let message = match column {
        0 => format!("{what} is indented by {}, and starts in column 1", spaces(own.indent)),
        _ => format!("{what} is indented by {} instead of {}", spaces(own.indent), spaces(column)),
    };
    let problem = RULE.at(message, source.span(own.word.clone()), spaces(own.indent));
    let problem = match meant.or_else(|| above.iter().find(|level| level.indent == column)) {
        Some(meant) if column > 0 => problem.label(source.span(meant.word.clone()), spaces(column)),
        _ => problem,
    };
    problem.help(way_out(&own, column, text))
}

fn way_out(line: &Level, column: usize, text: &str) -> String {
    let word = &text[line.word.clone()];
    match column {
        0 => format!("move `{word}` to column 1"),
        _ if line.is_dash => format!("indent this item by {}", spaces(column)),
        _ => format!("indent `{word}` by {}", spaces(column)),
    }
}

/// A key that is indented deeper than the one above it, which has a value in its line: YAML takes both lines for one
/// text, and stumbles over the colon.
fn deeper_below(line: &Range<usize>, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let below = source.line_below(line.end);
    let key = levels_of(&text[below.clone()], below.start).pop().filter(|key| !key.is_dash)?;
    let own = levels_of(&text[line.clone()], line.start).pop().filter(|own| has_value(own, text, source))?;
    let is_key = text[key.word.end..].starts_with(':') && below.start > line.start;
    (is_key && key.indent > own.indent).then(|| {
        let word = &text[key.word.clone()];
        RULE.at(
            format!("this line is indented by {}, deeper than the key above it", spaces(key.indent)),
            source.span(key.word.clone()),
            spaces(key.indent),
        )
        .label(source.span(own.word.clone()), format!("{}, with a value already", spaces(own.indent)))
        .suggest(
            format!("indent `{word}` by {}", spaces(own.indent)),
            moved(&key.word, key.indent, own.indent, text, source),
        )
        .otherwise("keys that belong together stand in one column")
    })
}

/// A key of a component at the start of a line ends all that was open, so that the lines after it seem to be wrong.
fn fallen_out(line: &Range<usize>, indent: usize, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let mut at = line.start;
    for _ in 0..MOST_ABOVE {
        let above = source.line_range(at.checked_sub(1)?);
        let content = &text[above.clone()];
        let key = content.split(':').next().unwrap_or("");
        if indent > 0 && !content.is_empty() && !content.starts_with([' ', '#']) {
            let is_fallen = COMPONENT_KEYS.contains(&key) && above.start > 0;
            let column = item_above(above.start, text);
            return is_fallen.then(|| {
                let problem = RULE
                    .at(
                        format!("`{key}` stands at the start of the line, outside of any component"),
                        source.span(above.start..above.start + key.len()),
                        "0 spaces",
                    )
                    .label(source.span(line.start + indent..line.end), "so this line belongs to nothing");
                let problem = match column {
                    Some(column) => problem.suggest(
                        format!("indent `{key}` by {}", spaces(column)),
                        [Edit::new(source.span(above.start..above.start), " ".repeat(column))],
                    ),
                    None => problem,
                };
                problem.otherwise(format!("`{key}` stands in the column of the other keys of its component"))
            });
        }
        at = above.start;
    }
    None
}

/// The column of the keys of the list item above a line.
fn item_above(start: usize, text: &str) -> Option<usize> {
    let line = text[..start].lines().rev().take(MOST_ABOVE).find(|line| line.trim_start().starts_with("- "))?;
    Some(line.len() - line.trim_start_matches([' ', '-']).len())
}

/// The line above a list item, if it starts the list and is another kind of line: without its `-`, or indented deeper.
fn first_of_list(item: &Level, line: &Range<usize>, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let above = source.line_range(line.start.checked_sub(1)?);
    let key = source.line_range(above.start.checked_sub(1)?);
    let levels = levels_of(&text[above.clone()], above.start);
    let start = levels.first().filter(|_| text[key.clone()].trim_end().ends_with(':'))?;
    let is_other_list = text[key.clone()].len() - text[key].trim_start_matches(' ').len() > item.indent;
    if start.is_dash && is_other_list {
        return (start.indent > item.indent).then(|| {
            let message = format!("this list item is indented by {}, and belongs to no list", spaces(item.indent));
            RULE.at(message, source.span(item.word.clone()), spaces(item.indent))
                .label(source.span(start.word.clone()), "another list")
                .help(ONE_COLUMN)
        });
    }
    if start.is_dash {
        return (start.indent > item.indent).then(|| uneven_items(item, start, "less deep", text, source));
    }
    let content = text[start.word.start..above.end].trim_end();
    (start.indent >= item.indent && !content.ends_with(':')).then(|| {
        RULE.at("missing `-` before the first item of this list", source.span(start.word.clone()), "no list item")
            .label(source.span(item.word.clone()), "a list item")
            .suggest(
                format!("write `- {content}`"),
                [Edit::new(source.span(above.start..start.word.start), format!("{}- ", " ".repeat(item.indent)))],
            )
            .otherwise("each item of a list starts with `- `")
    })
}

/// Two items of a list in different columns.
fn uneven_items(item: &Level, above: &Level, how: &str, text: &str, source: &SourceFile) -> Diagnostic {
    let message = format!("this list item is indented by {}, {how} than the one above it", spaces(item.indent));
    let problem = RULE
        .at(message, source.span(item.word.clone()), spaces(item.indent))
        .label(source.span(above.word.clone()), spaces(above.indent))
        .suggest(
            format!("indent this item by {}", spaces(above.indent)),
            moved(&item.word, item.indent, above.indent, text, source),
        )
        .suggest(
            format!("indent the item above by {}", spaces(item.indent)),
            moved(&above.word, above.indent, item.indent, text, source),
        )
        .otherwise(ONE_COLUMN);
    match aligned(item, above.indent, text, source) {
        edits if edits.len() > 1 => {
            problem.suggest(format!("indent this item and those below it by {}", spaces(above.indent)), edits)
        }
        _ => problem,
    }
}

/// Whether a level's word is a key with a value in the same line.
fn has_value(level: &Level, text: &str, source: &SourceFile) -> bool {
    let rest = &text[level.word.end..source.line_range(level.word.end).end];
    rest.strip_prefix(':').is_some_and(|value| !value.trim().is_empty() && !value.trim().starts_with('#'))
}

/// A list below a line that has a value already.
fn list_without_key(item: &Level, above: &Level, text: &str, source: &SourceFile) -> Diagnostic {
    let span = source.span(item.word.clone());
    let problem = RULE.at("this list belongs to no key", span, "indented deeper than the line above");
    let problem = problem.label(source.span(above.word.clone()), "this key has a value already");
    let line = source.line_range(item.word.start);
    let below = source.line_below(line.end);
    let (written, key) = (&text[line.clone()], &text[below.clone()]);
    let is_key = key.trim_end().ends_with(':') && key.len() - key.trim_start().len() == above.indent;
    // Right below a name, it may be the last one of the list above.
    let is_first =
        text[..line.start].trim_end().lines().next_back().is_some_and(|above| above.trim().starts_with("- "));
    match is_key && !is_first && written.contains(": ") {
        true => problem.suggest(
            format!("move it below `{}`", key.trim()),
            [Edit::new(source.span(line), key), Edit::new(source.span(below), written)],
        ),
        false => problem.help("a list stands below its own key, which has nothing after its colon"),
    }
}

fn diagnose(
    line: &Level,
    meant: &Level,
    is_misplaced_key: bool,
    above: &[Level],
    text: &str,
    source: &SourceFile,
) -> Diagnostic {
    let message = match is_misplaced_key {
        true => "this key is indented like the `-` of the list item above it, not like its keys".to_owned(),
        false => format!("this line is indented by {}, which matches no line above it", spaces(line.indent)),
    };
    let label = format!("{} are indented by {}", owner(meant, above, text), spaces(meant.indent));
    RULE.at(message, source.span(line.word.clone()), spaces(line.indent))
        .label(source.span(meant.word.clone()), label)
        .help(way_out(line, meant.indent, text))
}

/// Says whose keys stand at a level.
fn owner(level: &Level, above: &[Level], text: &str) -> &'static str {
    let outer: Vec<&Level> = above.iter().filter(|other| other.indent < level.indent).collect();
    match outer.as_slice() {
        _ if level.is_dash => "the items of this list",
        [section, item] if item.is_dash && &text[section.word.clone()] == "components" => "the keys of this component",
        _ => "the keys beside it",
    }
}

fn spaces(count: usize) -> String {
    if count == 1 { "1 space".to_owned() } else { format!("{count} spaces") }
}

/// The levels that are open, or were just left, at the start of a line: the deepest of the lines above it, without
/// those that a line in between has closed.
fn levels_above(text: &str, end: usize) -> Vec<Level> {
    let mut levels: Vec<Level> = Vec::new();
    let mut start = 0;
    for line in text[..end].split_inclusive('\n') {
        let words = levels_of(line, start);
        if let Some(first) = words.first() {
            levels.retain(|level| level.indent < first.indent || level.indent == first.indent && !first.is_dash);
            for word in words {
                if levels.iter().all(|level| level.indent != word.indent) {
                    levels.push(word);
                }
            }
        }
        start += line.len();
    }
    levels
}

/// The columns of one line: each `-`, and the word after them.
fn levels_of(line: &str, start: usize) -> Vec<Level> {
    let mut levels = Vec::new();
    let mut at = line.len() - line.trim_start_matches(' ').len();
    while line[at..].starts_with("- ") && levels.len() < MAX_DEPTH {
        levels.push(Level { indent: at, is_dash: true, word: start + at..start + at + 1 });
        at += 1;
        at += line[at..].len() - line[at..].trim_start_matches(' ').len();
    }
    let rest = line[at..].trim_end();
    if !rest.is_empty() && !rest.starts_with('#') {
        let length = rest.find([':', ' ', '#']).filter(|found| *found > 0).unwrap_or(rest.len());
        levels.push(Level { indent: at, is_dash: rest == "-", word: start + at..start + at + length });
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0105] this line is indented by 3 spaces, which matches no line above it
             --> topology.yaml:3:4
              |
            2 |   - name: sensor
              |     ---- the keys of this component are indented by 4 spaces
            3 |    gates:
              |    ^^^^^ 3 spaces
              |
              = help: indent `gates` by 4 spaces"#]],
        );
    }
}
