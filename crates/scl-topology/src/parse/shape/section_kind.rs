//! SCL0204: a section, or the list of gates, has the wrong kind.

use super::ends;
use super::shift::indented;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::model::ComponentModel;
use crate::parse::entry::Entry;
use crate::parse::field::{Field, end_with_colon};
use crate::parse::shape_word;
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0204.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0204",
    severity: Severity::Error,
    title: "section has the wrong kind",
    explanation: "The section must be a list, but is something else, often a mapping with names as keys. A list keeps \
                  the order of the file, and the checker can find duplicate names in it. Start each entry with `-`.",
    example: " components:
-  sensor:
+  - name: sensor
     gates:
       - measurements: pub
",
};

/// `components: {sensor: ...}`; `first` is the first component that could be read from it.
pub(in crate::parse) fn components(
    section: Field<'_>,
    first: Option<&ComponentModel>,
    entry: Entry,
    source: &SourceFile,
) -> Diagnostic {
    let name = first.map_or("...", |component| component.name.value.as_str());
    let label = format!("a key, where `- name: {name}` is expected");
    let problem = wrong_kind(section, first_key(section.value), label);
    let form = format!("each {} is an item of the list: `- name: {name}`, with its keys below", entry.word());
    match component_items(section.value, source) {
        Some(edits) => problem
            .propose(format!("start each {} with its name: `- name: {name}`", entry.word()), edits)
            .otherwise(form),
        None => problem.help(form),
    }
}

/// Makes `- name: sensor` of each `sensor:`, and `{name: sensor, ...}` of each `sensor: {...}`.
fn component_items(section: &Node, source: &SourceFile) -> Option<Vec<Edit>> {
    let NodeKind::Mapping { entries } = &section.kind else { return None };
    let mut edits = Vec::new();
    for (key, value) in entries {
        let name = source.snippet(key.span);
        let NodeKind::Mapping { entries: keys } = &value.kind else { return None };
        let first = keys.first()?.0.span;
        let head = Span { end: first.start, ..key.span };
        let between = source.snippet(Span { start: key.span.end, ..head });
        match between.contains('\n') {
            // The keys below keep their column.
            true => {
                let indent = source.line_column(first.start).column as usize;
                let column = source.line_column(key.span.start).column as usize;
                let colon = Span { end: end_with_colon(key.span, source), ..key.span };
                let dash = indent.checked_sub(3)?;
                let missing = dash.checked_sub(column - 1)?;
                edits.push(Edit::new(colon, format!("{}- name: {name}", " ".repeat(missing))));
            }
            false => {
                let start = if is_flow(section, source) { "" } else { "- " };
                edits.push(Edit::new(head, format!("{start}{{name: {name}, ")));
            }
        }
    }
    edits.extend(brackets(section, source));
    (!edits.is_empty()).then_some(edits)
}

/// `gates: {measurements: pub}`; `what` is an item of the list, for example a gate.
pub(in crate::parse) fn items(field: Field<'_>, what: &str, source: &SourceFile) -> Diagnostic {
    let key = first_key(field.value);
    let name = source.snippet(key);
    let span = Span { end: end_with_colon(key, source), ..key };
    let problem = wrong_kind(field, span, format!("a key, where `- {name}: ...` is expected"));
    let form = format!("each {what} is an item of a list: `- {name}: ...`");
    match gate_items(field.value, source) {
        Some(edits) => problem.propose(format!("start each {what} with `-`: `- {name}: ...`"), edits).otherwise(form),
        None => problem.help(form),
    }
}

/// Puts a dash before each key, or, in braces, braces around each entry. What belongs to a key stays below it: it is
/// indented as far as before, or two columns further if it would not be deeper than the name then.
fn gate_items(gates: &Node, source: &SourceFile) -> Option<Vec<Edit>> {
    let NodeKind::Mapping { entries } = &gates.kind else { return None };
    let mut edits = Vec::new();
    for (key, value) in entries {
        if is_flow(gates, source) {
            edits.push(Edit::new(Span { end: key.span.start, ..key.span }, "{"));
            edits.push(Edit::new(Span { start: value.span.end, ..value.span }, "}"));
            continue;
        }
        edits.push(Edit::new(Span { end: key.span.start, ..key.span }, "- "));
        let name = source.line_column(key.span.start).column;
        if source.line_column(value.span.start).column <= name + 2 {
            edits.extend(indented(Span { start: key.span.end, ..value.span }, 2, false, source));
        }
    }
    edits.extend(brackets(gates, source));
    Some(edits)
}

fn is_flow(value: &Node, source: &SourceFile) -> bool {
    source.snippet(value.span).starts_with('{')
}

/// Makes brackets of the braces around a mapping, if it has any.
fn brackets(value: &Node, source: &SourceFile) -> Vec<Edit> {
    let Span { start, end, .. } = value.span;
    match is_flow(value, source) {
        true => vec![
            Edit::new(Span { end: start + 1, ..value.span }, "["),
            Edit::new(Span { start: end - 1, ..value.span }, "]"),
        ],
        false => Vec::new(),
    }
}

const CONNECTION: &str = "each connection is an item of the list: `- [component.gate, component.gate]`";

/// `connections:` that are no list.
pub(in crate::parse) fn connections(section: Field<'_>, source: &SourceFile) -> Diagnostic {
    let problem = wrong_kind(section, first_key(section.value), String::new());
    let change = match &section.value.kind {
        NodeKind::Scalar { text, .. } => match ends::words(text).as_slice() {
            [first, second] => {
                let edit = Edit::new(section.value.span, format!("[[{first}, {second}]]"));
                Some(("write the connection as a pair in a list", vec![edit]))
            }
            _ => None,
        },
        _ => ends::of_section(section.value, source),
    };
    match change {
        Some((text, edits)) => problem.propose(text, edits).otherwise(CONNECTION),
        None => problem.help(CONNECTION),
    }
}

/// `schemas: rover.proto`, `schema_roots: proto`.
pub(in crate::parse) fn files(section: Field<'_>) -> Diagnostic {
    let key = section.key;
    let problem = wrong_kind(section, first_key(section.value), String::new());
    let written = |files: &[&str]| {
        let list = format!("[{}]", files.join(", "));
        (
            format!("write `{key}: {list}`"),
            Edit::new(Span { start: section.key_span.end, ..section.value.span }, format!(": {list}")),
        )
    };
    match &section.value.kind {
        NodeKind::Scalar { text, .. } => {
            let files: Vec<&str> = text.split([',', ' ', ';']).filter(|file| !file.is_empty()).collect();
            let (several, all) = written(&files);
            let (one, whole) = written(&[text.trim()]);
            match files.len() {
                1 => problem.propose(one, [whole]),
                _ => problem.suggest(several, [all]).suggest(one, [whole]),
            }
        }
        NodeKind::Mapping { .. } if key == "schemas" => problem.help(
            "`schemas` is a list of `.proto` files, which define the messages; they are not defined in this file",
        ),
        _ => problem.help(format!("the paths stand in brackets, or each on a line below `{key}:` after a `-`")),
    }
}

/// Text where a list belongs.
pub(in crate::parse) fn text(section: Field<'_>) -> Diagnostic {
    wrong_kind(section, section.value.span, String::new())
        .help(format!("each entry stands on a line of its own below `{}:`, after a `-`", section.key))
}

fn wrong_kind(section: Field<'_>, at: Span, label: String) -> Diagnostic {
    let message = format!("`{}` must be a list; this is {}", section.key, shape_word(section.value));
    let label = if label.is_empty() { format!("this is {}", shape_word(section.value)) } else { label };
    RULE.at(message, at, label)
}

fn first_key(value: &Node) -> Span {
    match &value.kind {
        NodeKind::Mapping { entries } => entries.first().map_or(value.span, |(key, _)| key.span),
        _ => value.span,
    }
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
                error: [SCL0204] `components` must be a list; this is a mapping
                 --> topology.yaml:2:3
                  |
                2 |   sensor:
                  |   ^^^^^^ a key, where `- name: sensor` is expected
                  |
                  = help: start each component with its name: `- name: sensor`"#]],
        );
    }
}
