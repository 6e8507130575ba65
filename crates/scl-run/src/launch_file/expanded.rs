//! Words of commands that seem to have a part that a shell or another tool replaces.

use super::placeholder::{Meaning, placeholders, replaced};
use super::reader::{Keys, Reader};
use super::rules::WRONG_VALUE;
use super::words::flow_word;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;
use std::ops::Range;

/// Operators of the shell that are no argument of any usual program.
pub(super) const OPERATORS: &[&str] = &["|", "||", "&&", ">", ">>", "2>", "2>>", "2>&1", "&>", "&>>", "1>"];

/// Maximum number of variables among which one is searched.
const MOST_VARIABLES: usize = 256;

impl Reader<'_> {
    /// Whether a word of a list seems to have a part that a shell or another tool replaces.
    pub(super) fn is_expanded(&self, item: &Node, word: &str, keys: &Keys<'_, '_>) -> bool {
        item.is_plain() && is_variable(word) || self.foreign(word, keys).next().is_some()
    }

    /// The problem of a word in a list that only a shell or another tool understands.
    pub(super) fn for_shell(
        &self,
        field: Field<'_>,
        items: &[Node],
        words: &[String],
        wrong: &Node,
        keys: &Keys<'_, '_>,
    ) -> Diagnostic {
        let word = wrong.text().unwrap_or_default();
        let message = match OPERATORS.contains(&word) {
            true => format!("the program would get `{word}` as an argument: a list is executed without a shell"),
            false => format!("`{word}` is passed on as it is: a list is executed without a shell"),
        };
        let problem = WRONG_VALUE.at(message, wrong.span, "");
        let expanded = || items.iter().zip(words).filter(|(item, word)| self.is_expanded(item, word, keys));
        let value = |meaning| match meaning {
            Meaning::Shell(name) | Meaning::Variable(name) => self.variable(name, keys),
            other => in_notation_of_shell(other),
        };
        let values = expanded().map(|(item, word)| {
            let value = replaced(word, value).filter(|value| !is_variable(value))?;
            Some((word.contains("$(find"), item.span, flow_word(&value)))
        });
        let values = values.collect::<Option<Vec<_>>>().filter(|values| !values.is_empty());
        let problem = match values {
            Some(values) => {
                let shown: Vec<&str> = values.iter().map(|(.., value)| value.as_str()).collect();
                let is_path = values.iter().any(|(is_path, ..)| *is_path);
                let what = if is_path { ", relative to the working directory" } else { "" };
                let text = format!("write `{}`{what}", shown.join("`, `"));
                problem.suggest(text, values.iter().map(|(_, at, value)| Edit::new(*at, value)))
            }
            None => problem,
        };
        let quoted = words.iter().zip(items).map(|(word, item)| {
            let is_syntax = item.is_plain() || self.foreign(word, keys).next().is_some();
            shell_word(&in_shell(word)?, is_syntax)
        });
        let line = quoted.collect::<Option<Vec<_>>>().map(|words| flow_word(&words.join(" ")));
        let entry = line.map(|line| format!("{}: {line}", field.key));
        let problem = problem.otherwise("write the value itself");
        match entry {
            Some(entry) => self.other_entry(problem, field, entry).note("a text is given to the shell if it needs one"),
            None => problem,
        }
    }

    /// The placeholders of a text that only other tools replace.
    fn foreign<'w>(&self, text: &'w str, keys: &Keys<'_, '_>) -> impl Iterator<Item = (Range<usize>, Meaning<'w>)> {
        let is_known = |name: &str| self.variable(name, keys).is_some();
        placeholders(text).into_iter().filter(move |(range, meaning)| {
            text.get(range.clone()).is_some_and(|written| meaning.is_foreign(written, is_known))
        })
    }

    /// The value of a variable that the file sets, for the program or for all.
    fn variable(&self, name: &str, keys: &Keys<'_, '_>) -> Option<String> {
        let own = keys.get("environment").map(|field| field.value);
        let all = own.into_iter().chain(self.top_value("environment")).filter_map(Node::entries).flatten();
        let mut same = all.take(MOST_VARIABLES).filter(|(key, _)| key.text() == Some(name));
        same.find_map(|(_, value)| value.text()).map(str::to_owned)
    }

    /// The problem of placeholders of other tools in a text, which the shell takes for its own syntax.
    pub(super) fn wrong_placeholder(&self, value: &Node, keys: &Keys<'_, '_>) -> Option<Diagnostic> {
        let written = self.written(value.span);
        let found: Vec<_> = self.foreign(written, keys).collect();
        let place = |range: &Range<usize>| {
            let start = value.span.start;
            Span { start: start + range.start as u32, end: start + range.end as u32, ..value.span }
        };
        let (first, _) = found.first()?;
        let shown = written.get(first.clone())?.trim_end_matches('/');
        let message = format!("`{shown}` is not replaced: the shell does not know this notation");
        let problem =
            WRONG_VALUE.at(message, Span { end: place(first).start + shown.len() as u32, ..place(first) }, "");
        let edits = found.iter().map(|(range, meaning)| Some(Edit::new(place(range), in_notation_of_shell(*meaning)?)));
        Some(match edits.collect::<Option<Vec<_>>>() {
            Some(edits) => {
                let text = match found.first() {
                    Some((_, Meaning::Variable(name))) => format!("write `${name}`"),
                    _ => "write a path relative to the working directory: without the package".to_owned(),
                };
                problem.suggest(text, edits)
            }
            None => problem.help("write the value itself, or `$NAME` for a variable of `environment`"),
        })
    }
}

/// What the shell replaces by what a placeholder stands for.
fn in_notation_of_shell(meaning: Meaning<'_>) -> Option<String> {
    match meaning {
        Meaning::Shell(name) | Meaning::Variable(name) => Some(format!("${name}")),
        Meaning::Package => Some(String::new()),
        Meaning::Other => None,
    }
}

/// A word with the placeholders of the shell in place of those of other tools.
fn in_shell(word: &str) -> Option<String> {
    replaced(word, in_notation_of_shell)
}

/// A word as a shell has to read it. What was not in quotes may be its syntax.
fn shell_word(word: &str, is_plain: bool) -> Option<String> {
    let is_syntax = OPERATORS.contains(&word) || is_plain && (is_variable(word) || word.starts_with("~/"));
    match is_syntax {
        true if word.contains(' ') => None,
        true => Some(word.to_owned()),
        false => shlex::try_quote(word).ok().map(|word| word.into_owned()),
    }
}

/// Whether a shell would replace a part of a word by a variable or by the output of a command.
pub(super) fn is_variable(word: &str) -> bool {
    word.split('$')
        .skip(1)
        .any(|rest| rest.starts_with(|next: char| next.is_ascii_alphabetic() || "_{(".contains(next)))
}
