//! Values of another shape than their key needs, and what they are as this format writes them.

use super::command::command_words;
use super::keys;
use super::likely::likely;
use super::reader::{Reader, wrong};
use super::rules::WRONG_SHAPE;
use super::value::{shown, texts};
use super::words::{bare, flow_list, flow_word};
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::{Field, damaged_key};
use scl_topology::source::Span;
use scl_topology::yaml::{Node, NodeKind};
use std::collections::HashSet;

/// Keys of other tools that give an item of a list its name.
const NAMES: [&str; 4] = ["name", "id", "key", "component"];

impl Reader<'_> {
    /// Returns the entries of a mapping. Any other value is reported with `message` and what `advise` adds, unless it
    /// could not be read, which has been reported.
    pub(super) fn entries<'n>(
        &mut self,
        field: Field<'n>,
        message: &str,
        advise: impl FnOnce(&Self, Diagnostic) -> Diagnostic,
    ) -> Option<&'n [(Node, Node)]> {
        let entries = field.value.entries();
        if entries.is_none() && !matches!(field.value.kind, NodeKind::Unread) {
            let problem = damaged_key(field.value, self.source, self.dialect).unwrap_or_else(|| {
                let problem = wrong(&WRONG_SHAPE, format!("{message}, not {}", shown(field.value)), field);
                advise(self, problem)
            });
            self.report(problem);
        }
        entries
    }

    /// Adds the proposal to write a list of named items as a mapping, if it is one.
    pub(super) fn as_mapping(&self, problem: Diagnostic, field: Field<'_>) -> Diagnostic {
        match self.without_names(field) {
            Some(edit) => problem.propose("write each name as a key, in place of its `-`", [edit]),
            None => problem,
        }
    }

    /// A list of items with names, or of mappings with one key, as a mapping from names.
    pub(super) fn without_names(&self, field: Field<'_>) -> Option<Edit> {
        let items = field.value.items()?;
        let text = self.source.text();
        let (first, last) = (items.first()?.span, items.last()?.span);
        let start = self.source.line_start(self.source.line_column(first.start).line as usize - 1);
        let head = text.get(start..first.start as usize)?;
        let indent = head.find('-')?;
        if !head[..indent].trim().is_empty() || !head[indent + 1..].trim().is_empty() {
            return None;
        }
        let mut out = String::new();
        let mut at = start;
        for item in items {
            let (key, value) = item.entries()?.first()?;
            let name = key.text()?;
            let dash = text.get(at..key.span.start as usize)?.rfind('-')? + at;
            out.push_str(text.get(at..dash)?);
            let is_name = NAMES.contains(&name) && value.text().is_some();
            if !is_name && item.entries()?.len() > 1 {
                return None;
            }
            at = if is_name { value.span.end as usize } else { key.span.start as usize };
            match (is_name, self.is_flow(item)) {
                (true, false) => out.push_str(&format!("{}:", value.text()?)),
                (true, true) => {
                    let rest = text.get(at..item.span.end as usize)?.trim_start_matches([',', ' ']);
                    out.push_str(&format!("{}: {{{rest}", value.text()?));
                    at = item.span.end as usize;
                }
                (false, false) => out.push_str(&" ".repeat(key.span.start as usize - dash)),
                (false, true) => return None,
            }
        }
        out.push_str(text.get(at..last.end as usize)?);
        // A list may have the column of its key; a mapping may not.
        let column = self.source.column(field.key_span.start);
        let deeper = if indent <= column { "  " } else { "" };
        let lines: Vec<String> = out.split('\n').map(|line| format!("{deeper}{line}")).collect();
        Some(Edit::new(Span { start: start as u32, ..last }, lines.join("\n")))
    }

    /// Adds the proposal to write variables as a mapping.
    pub(super) fn as_variables(&self, problem: Diagnostic, field: Field<'_>) -> Diagnostic {
        match variables(field.value).as_slice() {
            [variables] => self.whole(problem, field, format!("{}: {variables}", field.key)),
            ways => ways.iter().fold(problem, |problem, variables| {
                self.other_entry(problem, field, format!("{}: {variables}", field.key))
            }),
        }
    }

    /// Adds the proposal to write a command, which stands for an entry, as an entry.
    pub(super) fn as_entry(&self, problem: Diagnostic, field: Field<'_>) -> Diagnostic {
        let is_command = field.value.text().is_some() || texts(field.value).is_some_and(|words| !words.is_empty());
        let list = || texts(field.value).map(|words| flow_list(&words));
        match self.in_brackets(field.value).or_else(list).filter(|_| is_command) {
            Some(command) => self.whole(problem, field, format!("{}: {{command: {command}}}", field.key)),
            None => problem,
        }
    }

    /// Adds the proposal to write a list of mappings with one key, as one mapping.
    pub(super) fn as_one_mapping(&self, problem: Diagnostic, field: Field<'_>) -> Diagnostic {
        let items = field.value.items().unwrap_or_default();
        let pairs = items.iter().map(|item| match item.entries()? {
            [(key, value)] => Some(format!("{}: {}", key.text()?, self.in_brackets(value)?)),
            _ => None,
        });
        match pairs.collect::<Option<Vec<_>>>().filter(|pairs| !pairs.is_empty()) {
            Some(pairs) => self.whole(problem, field, format!("{}: {{{}}}", field.key, pairs.join(", "))),
            None => problem,
        }
    }

    /// Adds the proposal to write the word of `restart` in `defaults`.
    pub(super) fn as_defaults(&self, problem: Diagnostic, field: Field<'_>) -> Diagnostic {
        let word = field.value.text().and_then(|text| {
            let is_word = super::likely::fits("restart", field.value);
            let near = || likely("restart", field.value).values.into_iter().next();
            if is_word { Some(text.to_owned()) } else { near() }
        });
        match word {
            Some(word) => self.whole(problem, field, format!("defaults: {{restart: {word}}}")),
            None => self.as_one_mapping(problem, field),
        }
    }

    /// Adds the certain proposal of another entry in place of a whole one.
    pub(super) fn whole(&self, problem: Diagnostic, field: Field<'_>, entry: String) -> Diagnostic {
        match self.replace_entry(field, entry.clone()) {
            Some(edit) => problem.propose(format!("write `{entry}`"), [edit]),
            None => problem,
        }
    }

    /// As [`whole`](Self::whole), for an entry that may be meant.
    pub(super) fn other_entry(&self, problem: Diagnostic, field: Field<'_>, entry: String) -> Diagnostic {
        match self.replace_entry(field, entry.clone()) {
            Some(edit) => problem.suggest(format!("write `{entry}`"), [edit]),
            None => problem,
        }
    }

    /// The entries of a section up to the first that belongs to another one, whose key is missing above it; this is
    /// reported.
    pub(super) fn own_entries<'n>(&mut self, section: Field<'n>, entries: &'n [(Node, Node)]) -> &'n [(Node, Node)] {
        let other =
            entries.iter().enumerate().find_map(|(at, (_, value))| Some((at, other_section(section.key, value)?)));
        let Some((at, key)) = other.filter(|(_, key)| self.top_value(key).is_none()) else { return entries };
        let name = entries[at].0.span;
        let message = format!("`{key}:` is missing above `{}`", self.written(name));
        let problem = WRONG_SHAPE.at(message, name, format!("not an entry of `{}`", section.key));
        let start = self.source.line_start(self.source.line_column(name.start).line as usize - 1) as u32;
        let indent = " ".repeat(self.source.column(section.key_span.start));
        let is_block = self.written(Span { start, end: name.start, ..name }).trim().is_empty();
        let edit = Edit::new(Span { start, end: start, ..name }, format!("{indent}{key}:\n"));
        self.report(if is_block { problem.propose(format!("write `{key}:` above it"), [edit]) } else { problem });
        self.missing_sections.push(key);
        &entries[..at]
    }

    /// Reports entries of components that stand at the top of the file, and returns the places of their names.
    pub(super) fn check_outer_components(&mut self, fields: &[Field<'_>], has_components: bool) -> HashSet<Span> {
        let is_known = |field: &Field<'_>| keys::TOP.iter().any(|key| key.name == field.key) || keys::is_own(field.key);
        let is_outer = |field: &&Field<'_>| !is_known(field) && self.is_outer_component(field, has_components);
        let outer: Vec<Field<'_>> = fields.iter().filter(is_outer).copied().collect();
        let Some(first) = outer.first() else { return HashSet::new() };
        let message = format!("component `{}` stands at the top of the file", first.key);
        let problem = WRONG_SHAPE.at(message, first.key_span, "");
        let problem = problem.labels(outer.iter().skip(1).map(|field| (field.key_span, "this one too")));
        let inner = fields.iter().find(|field| field.key == "components").and_then(|field| field.value.entries());
        let inner = inner.and_then(|entries| entries.first());
        let indent = inner.map_or(2, |(key, _)| self.source.column(key.span.start));
        let problem = match self.indented(&outer, indent) {
            Some((all, text)) if has_components => {
                problem.propose("indent it below `components`", [Edit::new(all, text)])
            }
            Some((all, text)) => {
                let text = format!("components:\n{text}");
                problem.propose("write `components:` above it, and indent it", [Edit::new(all, text)])
            }
            None => problem,
        };
        self.report(problem.otherwise("the entries of components stand below `components`"));
        outer.iter().map(|field| field.key_span).collect()
    }

    /// Whether an entry at the top of the file is that of a component, or its command.
    fn is_outer_component(&self, field: &Field<'_>, has_components: bool) -> bool {
        let is_key = |key: &Node| key.text().is_some_and(|key| keys::COMPONENT.iter().any(|known| known.name == key));
        match field.value.entries() {
            Some(entries) => {
                let is_entry = !entries.is_empty() && entries.iter().all(|(key, _)| is_key(key));
                is_entry && (!self.is_flow(field.value) || !has_components)
            }
            // As in a Procfile: only names of the topology are known to be components.
            None => {
                let is_component =
                    self.known.is_some_and(|known| known.components.iter().any(|name| name == field.key));
                is_component && !has_components && command_words(field.value).is_some()
            }
        }
    }

    /// Entries of components with this indentation, and their place; `None` if they stand in the middle of lines.
    fn indented(&self, entries: &[Field<'_>], indent: usize) -> Option<(Span, String)> {
        let (first, last) = (entries.first()?, entries.last()?);
        let all = first.key_span.to(self.whole_entry(*last)?);
        if self.source.line_column(all.start).column != 1 {
            return None;
        }
        let mut text = String::new();
        let mut at = all.start;
        for field in entries {
            text.push_str(self.written(Span { start: at, end: field.key_span.start, ..all }));
            let whole = self.whole_entry(*field)?;
            match field.value.entries() {
                Some(_) => text.push_str(self.written(whole)),
                None => text.push_str(&format!("{}: {{command: {}}}", field.key, self.in_brackets(field.value)?)),
            }
            at = whole.end;
        }
        let lines = text.split('\n').map(|line| match line.trim().is_empty() {
            true => String::new(),
            false => format!("{}{line}", " ".repeat(indent)),
        });
        Some((all, lines.collect::<Vec<_>>().join("\n")))
    }
}

/// The section that an entry belongs to, if it is not the one that it stands in.
fn other_section(section: &str, value: &Node) -> Option<&'static str> {
    let entries = value.entries().filter(|entries| !entries.is_empty())?;
    let has = |node: &Node, names: &[&str]| {
        let mut keys = node.entries().into_iter().flatten().filter_map(|(key, _)| key.text());
        keys.any(|key| names.contains(&key))
    };
    if section != "hosts" && has(value, &["address"]) {
        return Some("hosts");
    }
    let is_name =
        |key: &Node| key.text().is_some_and(|key| key != "<<" && keys::COMPONENT.iter().all(|it| it.name != key));
    let is_entry = |(name, entry): &(Node, Node)| is_name(name) && has(entry, &["command", "replay"]);
    (section != "profiles" && entries.iter().all(is_entry)).then_some("profiles")
}

/// Variables as a mapping: those of a list `A=b`, of a text, or of items with names. Two ways if a comma in a text may
/// belong to a value.
pub(super) fn variables(value: &Node) -> Vec<String> {
    let ways = match value.text() {
        Some(line) => match separated_by_commas(line) {
            Some(pairs) if line.contains(['"', '\'']) => vec![pairs],
            pairs => pairs.into_iter().chain(separated_by_spaces(line)).collect(),
        },
        None => value.items().and_then(|items| items.iter().map(variable).collect()).into_iter().collect(),
    };
    let ways = ways.into_iter().filter(|pairs: &Vec<_>| !pairs.is_empty());
    let shown = ways.map(|pairs| {
        let pairs = pairs.iter().map(|(name, value)| format!("{}: {}", flow_word(name), flow_word(value)));
        format!("{{{}}}", pairs.collect::<Vec<_>>().join(", "))
    });
    shown.collect()
}

fn separated_by_spaces(line: &str) -> Option<Vec<(String, String)>> {
    shlex::split(line)?.iter().filter(|word| *word != "export").map(|word| pair(word)).collect()
}

/// At least two variables, as in `A="b",C="d"`.
fn separated_by_commas(line: &str) -> Option<Vec<(String, String)>> {
    let mut quote = None;
    let pieces: Vec<&str> = line
        .split(|letter| {
            quote = match quote {
                Some(open) if open == letter => None,
                None if matches!(letter, '"' | '\'') => Some(letter),
                open => open,
            };
            letter == ',' && quote.is_none()
        })
        .collect();
    let pairs: Option<Vec<_>> = pieces.iter().map(|piece| pair(piece.trim())).collect();
    pairs.filter(|pairs| pairs.len() > 1)
}

/// `NAME=value`, the whole or its value perhaps in quotes.
fn pair(word: &str) -> Option<(String, String)> {
    let (name, value) = word.split_once('=')?;
    let is_name = !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    let inner = |quote| value.strip_prefix(quote)?.strip_suffix(quote);
    let bare = inner('"').or_else(|| inner('\'')).unwrap_or(value);
    is_name.then(|| (name.to_owned(), bare.to_owned()))
}

/// A variable in a list: `A=b`, `A: b`, or its name and its value.
fn variable(item: &Node) -> Option<(String, String)> {
    if let Some(word) = item.text() {
        return pair(word);
    }
    let entries = item.entries()?;
    let get = |names: &[&str]| {
        let found = entries.iter().find(|(key, _)| key.text().is_some_and(|key| names.contains(&bare(key).as_str())));
        found.and_then(|(_, value)| value.text()).map(str::to_owned)
    };
    match entries {
        [(key, value)] => Some((key.text()?.to_owned(), value.text()?.to_owned())),
        _ => Some((get(&["name"])?, get(&["value"])?)),
    }
}
