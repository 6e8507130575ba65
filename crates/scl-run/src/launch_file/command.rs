//! Commands: their words, and what no program can have been meant to get.

use super::super::command_line;
use super::expanded::OPERATORS;
use super::reader::{Keys, Reader};
use super::rules::WRONG_VALUE;
use super::value::{text, texts};
use super::words::{flow_list, flow_word};
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

/// Quotes of word processors.
const CURLY: &[char] = &['“', '”', '„', '‘', '’', '«', '»'];

/// Parts of a command that other tools write as keys of their own, in the order of the words.
const PARTS: [&[&str]; 3] = [
    &["interpreter", "entrypoint", "launchprefix", "prefix", "wrapper", "interpreterargs", "nodeargs"],
    &["command", "cmd", "run", "exec", "program", "execstart", "executable", "script", "path", "binary", "main"],
    &["args", "arguments", "argv", "argument", "flags", "options"],
];

/// Where a word belongs in a command, if it is a part of one.
fn part(word: &str) -> Option<usize> {
    let word = super::words::bare(word);
    PARTS.iter().position(|words| words.contains(&word.as_str()))
}

/// Whether a word is a key of other tools that gives only a part of a command.
pub(super) fn is_part(word: &str) -> bool {
    part(word).is_some()
}

/// The program and arguments of a command: a list as it is, the words of a text. `None` if the value is not a command.
pub(super) fn command_words(value: &Node) -> Option<Vec<String>> {
    let line = text(value).filter(|line| !line.trim().is_empty());
    let words = line.map(command_line::words).or_else(|| texts(value))?;
    words.first().is_some_and(|program| !program.is_empty()).then_some(words)
}

impl Reader<'_> {
    /// Reports a command that is written as several keys. Returns whether it was.
    pub(super) fn check_command_parts(&mut self, keys: &Keys<'_, '_>, unknown: &[Field<'_>], owner: &str) -> bool {
        let is_part_here = |field: &&Field<'_>| is_part(field.key);
        let mut parts: Vec<Field<'_>> = keys.fields.list.iter().filter(is_part_here).copied().collect();
        let Some(told) = unknown.iter().find(is_part_here) else { return false };
        // An entry point alone is the command.
        if parts.len() < 2 || parts.iter().filter(|field| part(field.key) == Some(1)).count() > 1 {
            return false;
        }
        let place = parts.iter().find(|field| field.key == "command").copied().unwrap_or(parts[0]);
        parts.sort_by_key(|field| part(field.key));
        let problem = super::likely_key::problem(told.key, told.key_span, owner);
        let others = unknown.iter().filter(|field| is_part(field.key) && field.key_span != told.key_span);
        let problem = problem.labels(others.map(|field| (field.key_span, "unknown too")));
        let edits = joined(&parts).and_then(|command| {
            let others = parts.iter().filter(|field| field.key_span != place.key_span);
            let mut edits: Vec<Edit> = others.map(|field| self.remove_entry(*field)).collect::<Option<_>>()?;
            let command = format!("command: {command}");
            edits.push(self.replace_entry(place, command.clone())?);
            Some((command, edits))
        });
        let problem = match edits {
            // A program of a package of another tool may have another path.
            Some((command, edits)) if keys.fields.list.iter().any(|field| matches!(field.key, "pkg" | "package")) => {
                problem.suggest(format!("write `{command}`"), edits)
            }
            Some((command, edits)) => problem.propose(format!("write `{command}`"), edits),
            None => problem,
        };
        self.report(problem.otherwise("`command` has the program and all of its arguments"));
        true
    }

    /// Reports words of a command that no program can have been meant to get.
    /// `keys` are those of its entry.
    pub(super) fn check_command(&mut self, field: Field<'_>, keys: &Keys<'_, '_>) {
        let problem = match field.value.items() {
            Some(items) => self.wrong_list(field, items, keys),
            None => self.wrong_text(field, keys),
        };
        problem.into_iter().for_each(|problem| self.report(problem));
    }

    fn wrong_list(&self, field: Field<'_>, items: &[Node], keys: &Keys<'_, '_>) -> Option<Diagnostic> {
        let words = texts(field.value)?;
        let (program, first) = (words.first()?, items.first()?);
        // What a shell or a program on another host gets is its own language.
        if words.iter().any(|word| word == "-c") || program.rsplit('/').next() == Some("ssh") {
            return None;
        }
        if let Some(problem) = self.escaped_path(first, program) {
            return Some(problem);
        }
        if first.is_plain() && program.contains(' ') {
            let message = format!("`{program}` is a single word of this list, so it is the name of the program");
            let parts: Vec<&str> = program.split_whitespace().collect();
            let split: Vec<String> = parts.iter().map(|part| flow_word(part)).collect();
            let problem = WRONG_VALUE.at(message, first.span, "").note("a name with spaces is written in quotes");
            let separator = self.separator(field.value, first);
            let text = format!("write each word as an item: `{}`", split.join(", "));
            return Some(problem.propose(text, [Edit::new(first.span, split.join(&separator))]));
        }
        for (item, word) in items.iter().zip(&words) {
            if let Some(problem) = self.wrong_characters(item, word) {
                return Some(problem);
            }
            let is_operator = OPERATORS.contains(&word.as_str());
            let is_home = word.starts_with("~/") && (item.is_plain() || item.span == first.span);
            if is_operator || is_home || self.is_expanded(item, word, keys) {
                return Some(self.for_shell(field, items, &words, item, keys));
            }
        }
        self.options_with_values(field.value, items)
    }

    /// The problem of items that hold an option and its value.
    fn options_with_values(&self, list: &Node, items: &[Node]) -> Option<Diagnostic> {
        let both: Vec<(&Node, &str, &str)> = items
            .iter()
            .filter(|item| item.is_plain())
            .filter_map(|item| {
                let (option, value) = item.text()?.split_once(' ')?;
                let is_option = option.starts_with("--") && !option.contains('=') && option.len() > 2;
                (is_option && !value.contains(' ')).then_some((item, option, value))
            })
            .collect();
        let (first, option, value) = both.first()?;
        let message = format!("`{option} {value}` is a single word of this list, so it is a single argument");
        let problem = WRONG_VALUE.at(message, first.span, "");
        let problem = problem.labels(both.iter().skip(1).map(|(item, ..)| (item.span, "this one too")));
        let what = if both.len() == 1 { "write two items:" } else { "write each as two items, like" };
        let text = format!("{what} `{}` and `{}`", flow_word(option), flow_word(value));
        let edits = both.iter().map(|(item, option, value)| {
            let separator = self.separator(list, item);
            Edit::new(item.span, format!("{}{separator}{}", flow_word(option), flow_word(value)))
        });
        Some(problem.propose(text, edits).note("an argument with spaces is written in quotes"))
    }

    fn wrong_text(&self, field: Field<'_>, keys: &Keys<'_, '_>) -> Option<Diagnostic> {
        let line = field.value.text()?;
        let written = self.written(field.value.span);
        if (field.value.is_plain() || written.starts_with('>')) && line.contains("\\ ") {
            let breaks = continued_lines(written);
            if let Some(first) = breaks.first() {
                let start = field.value.span.start;
                let at = |at: usize| Span { start: start + at as u32, end: start + at as u32 + 1, ..field.value.span };
                let problem = WRONG_VALUE.at("this `\\` becomes a part of the next word", at(*first), "");
                let problem = problem.note("YAML joins the lines of a text by a space, without any mark");
                let edits = breaks.iter().map(|at_line| {
                    let before = written[..*at_line].trim_end_matches(' ').len() as u32 + start;
                    Edit::new(Span { start: before, ..at(*at_line) }, "")
                });
                return Some(problem.propose("remove the `\\` at the end of the line", edits));
            }
        }
        if let Some(problem) = self.wrong_placeholder(field.value, keys) {
            return Some(problem);
        }
        if !field.value.is_plain() {
            return None;
        }
        self.wrong_characters(field.value, line)
    }

    /// A problem of characters that a word processor has put into a command.
    pub(super) fn wrong_characters(&self, value: &Node, text: &str) -> Option<Diagnostic> {
        let is_start = |at: usize| text[..at].chars().next_back().is_none_or(|before| " =\"'".contains(before));
        let quote = text.char_indices().find(|(at, letter)| CURLY.contains(letter) && is_start(*at));
        let straight = |written: &str| {
            let quote = |letter: char| if "‘’".contains(letter) { '\'' } else { '"' };
            written
                .chars()
                .map(|letter| if CURLY.contains(&letter) { quote(letter) } else { letter })
                .collect::<String>()
        };
        let written = self.written(value.span);
        if let Some((_, letter)) = quote.filter(|_| value.is_plain()) {
            let message = format!("`{letter}` is not a quote here: it becomes a part of the word");
            let edit = Edit::new(value.span, straight(written));
            return Some(
                WRONG_VALUE.at(message, value.span, "").propose(format!("write `{}`", straight(written)), [edit]),
            );
        }
        let dash = text.char_indices().find(|(at, letter)| "–—".contains(*letter) && is_start(*at))?;
        if !value.is_plain()
            || text[dash.0 + dash.1.len_utf8()..].chars().next().is_none_or(|next| !next.is_alphabetic())
        {
            return None;
        }
        let message = format!("`{}` is not the hyphen that options start with", dash.1);
        let meant = written.replacen(dash.1, "--", 1);
        let problem = WRONG_VALUE.at(message, value.span, "");
        Some(problem.suggest(format!("write `{meant}`"), [Edit::new(value.span, meant)]))
    }

    /// What stands between the items of a list.
    fn separator(&self, list: &Node, item: &Node) -> String {
        match self.is_flow(list) {
            true => ", ".to_owned(),
            false => {
                let column = self.source.column(list.span.start);
                let dash = self.source.column(item.span.start);
                format!("\n{}-{}", " ".repeat(column), " ".repeat(dash.saturating_sub(column + 1).max(1)))
            }
        }
    }
}

/// One command of its parts, as YAML.
fn joined(parts: &[Field<'_>]) -> Option<String> {
    let lines: Option<Vec<&str>> = parts.iter().map(|field| text(field.value)).collect();
    if let Some(lines) = lines {
        return Some(flow_word(&lines.join(" ")));
    }
    let mut words = Vec::new();
    for field in parts {
        match text(field.value) {
            Some(line) => words.extend(shlex::split(line)?),
            None => words.extend(texts(field.value)?),
        }
    }
    Some(flow_list(&words))
}

/// The places of backslashes at the ends of lines.
fn continued_lines(written: &str) -> Vec<usize> {
    let mut breaks = Vec::new();
    let mut start = 0;
    for line in written.split_inclusive('\n') {
        let content = line.trim_end();
        if line.ends_with('\n') && content.ends_with('\\') && !content.ends_with("\\\\") {
            breaks.push(start + content.len() - 1);
        }
        start += line.len();
    }
    breaks
}
