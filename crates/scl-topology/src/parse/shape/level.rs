//! SCL0214: a key that belongs elsewhere.

use super::{moved, shift};
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity, removal};
use crate::grammar;
use crate::model::ComponentModel;
use crate::parse::entry::Entry;
use crate::parse::field::{Field, Fields, head};
use crate::parse::with_dash;
use crate::parse::words::{COMPONENT_KEYS, SECTIONS, is_kind, is_option};
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0214.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0214",
    severity: Severity::Error,
    title: "key at the wrong level",
    explanation: "The key is valid, but at another level: a section is inside a component, an option is beside a gate, \
                  or `gates` is at the top. Usually the indentation is wrong. Move the key to where the message says.",
    example: " components:
   - name: controller
     gates:
       - sensor: sub
   - name: sensor
     gates:
       - measurements: pub
-    connections:
-      - [sensor.measurements, controller.sensor]
+connections:
+  - [sensor.measurements, controller.sensor]
",
};

/// A key of a component, or of a gate, at the top level; `above` is the component above it.
pub(in crate::parse) fn at_top(
    field: Field<'_>,
    above: Option<&ComponentModel>,
    source: &SourceFile,
) -> Option<Diagnostic> {
    let key = field.key;
    // `kind` with a list is the section `kinds`.
    let is_section = key == grammar::KIND && field.value.text().is_none();
    if COMPONENT_KEYS.contains(&key) && !is_section {
        let message = format!("`{key}` belongs inside a component, not at the top level");
        let problem = problem(message, field.key_span, source);
        if key == "name" {
            let renamed = [Edit::new(field.key_span, "system")];
            return Some(problem.suggest("the name of the whole system is called `system`", renamed));
        }
        let Some(above) = above else {
            return Some(problem.help("the keys of a component stand below its `- name:`"));
        };
        let by = key_column(above, source).saturating_sub(source.column(field.key_span.start));
        let edits = shift::indented(field.key_span.to(field.value.span), by, true, source);
        let text = format!("indent it below the name of component `{}`", above.name.value);
        return Some(problem.suggest(text, edits));
    }
    let message = format!("`{key}` belongs inside a gate, not at the top level");
    is_option(key).then(|| problem(message, field.key_span, source).help(in_gate(field)))
}

/// The column of the keys of a component.
fn key_column(component: &ComponentModel, source: &SourceFile) -> usize {
    let head = shift::head(component.name.span.start, source);
    head.len() - head.trim_start_matches([' ', '-']).len()
}

/// A section, or an option of a gate, in a component.
pub(in crate::parse) fn in_component(
    field: Field<'_>,
    component: &str,
    entry: Entry,
    source: &SourceFile,
) -> Option<Diagnostic> {
    let (key, word) = (field.key, entry.word());
    if SECTIONS.contains(&key) {
        let message = format!("`{key}` belongs at the top level, not inside {word} `{component}`");
        let problem = problem(message, field.key_span, source);
        if key == "components" {
            return Some(
                problem.help("components are not nested: each of them is an item of the one list `components`"),
            );
        }
        let whole = field.key_span.to(field.value.span);
        let edits = shift::outdented(whole, source.column(whole.start), true, source).filter(|edits| !edits.is_empty());
        return Some(match edits {
            Some(edits) => problem.propose("move it to column 1", edits),
            None => problem.help("sections start in column 1"),
        });
    }
    let message = format!("`{key}` belongs inside a gate, not beside the gates of {word} `{component}`");
    is_option(key).then(|| problem(message, field.key_span, source).help(in_gate(field)))
}

/// `- measurements: pub` with `queue: 4` below it.
pub(in crate::parse) fn option_beside_gate(option: Field<'_>, gate: Field<'_>, source: &SourceFile) -> Diagnostic {
    let message = format!("`{}` belongs inside the braces of gate `{}`, not beside it", option.key, gate.key);
    let problem = problem(message, option.key_span, source);
    let entry = option.key_span.to(option.value.span);
    let written = source.snippet(entry);
    let at = |place: u32| Span { start: place, end: place, ..entry };
    let into = match &gate.value.kind {
        NodeKind::Scalar { text, .. } if is_kind(text) => {
            let braces = format!("{{{text}: , {written}}}");
            Some((format!("write `{}: {braces}`", gate.key), Edit::new(gate.value.span, braces)))
        }
        NodeKind::Mapping { entries } => match (source.snippet(gate.value.span).starts_with('{'), entries.first()) {
            (true, _) => {
                let end = at(gate.value.span.end - 1);
                Some((format!("write `{written}` in the braces"), Edit::new(end, format!(", {written}"))))
            }
            (false, Some((first, _))) => {
                let deeper = source.column(first.span.start).saturating_sub(source.column(entry.start));
                let indented = shift::indented(entry, deeper, true, source);
                return problem.propose(format!("indent it like the other keys of gate `{}`", gate.key), indented);
            }
            _ => None,
        },
        _ => None,
    };
    match (into, removal(source, entry)) {
        (Some((text, edit)), Some(removed)) if !written.contains('\n') => problem.propose(text, [edit, removed]),
        _ => problem.help(in_gate(option)),
    }
}

/// A gate whose dash stands in the column of the components' dashes.
pub(in crate::parse) fn gate_among_components(
    item: &Node,
    above: &ComponentModel,
    entry: Entry,
    source: &SourceFile,
) -> Diagnostic {
    let (word, owner) = (entry.word(), &above.name.value);
    let name = source.snippet(item.span);
    let name = name.split([':', '\n']).next().unwrap_or("");
    let start = with_dash(item.span, source);
    let end = item.span.start + name.len() as u32;
    let message = format!("gate `{name}` stands among the {}", entry.section());
    let problem = RULE.at(message, Span { end, ..start }, format!("starts a {word} of its own"));
    match above.gates.last() {
        Some(gate) => {
            let head = shift::head(gate.name.span.start, source);
            let dash = head.len() - head.trim_start_matches(' ').len();
            let by = dash.saturating_sub(source.column(start.start));
            let text = format!("indent it like the gates of {word} `{owner}`");
            let problem = problem.label(gate.name.span, "the gate above");
            match by {
                0 => problem.help(format!("the gates of {word} `{owner}` stand in its `gates`")),
                _ => problem.propose(text, shift::indented(start, by, true, source)),
            }
        }
        None => problem.help(format!("a gate stands below the `gates:` of its {word}, `{owner}`")),
    }
}

/// The key and the value of `name` among the keys of a component; none among other keys.
pub(in crate::parse) fn component_name(entries: &[(Node, Node)]) -> Option<&(Node, Node)> {
    let find = |key: &str| entries.iter().find(|(node, _)| node.text() == Some(key));
    find("name").filter(|_| find("gates").is_some_and(|(_, gates)| gates.text().is_none()))
}

/// A component in another list. It belongs below the component `above`.
pub(in crate::parse) fn component_among(
    list: &str,
    item: Span,
    (key, name): &(Node, Node),
    above: Option<Span>,
    entry: Entry,
    source: &SourceFile,
) -> Diagnostic {
    let (word, section) = (entry.word(), entry.section());
    let message = format!("{word} `{}` stands in the list of {list}", name.text().unwrap_or(""));
    let problem = RULE.at(message, key.span.to(name.span), format!("a {word}"));
    match above.and_then(|above| moved::below(item, above, source)) {
        Some(edits) => problem.propose(format!("move it into the list `{section}`"), edits),
        None => problem,
    }
    .otherwise(format!("{section} stand in the list `{section}`"))
}

/// `- measurements:` with `pub: Type` below it, in the same column as the name.
pub(in crate::parse) fn kind_beside_name(
    kind: Field<'_>,
    gate: Field<'_>,
    item: Span,
    source: &SourceFile,
) -> Diagnostic {
    let message = format!("`{}` stands beside the name of gate `{}`, not below it", kind.key, gate.key);
    let problem = problem(message, kind.key_span, source).label(gate.key_span, "the gate's name");
    let below = Span { start: gate.key_span.end, ..item };
    let edits = shift::indented(below, 2, false, source);
    match edits.is_empty() {
        true => problem.help("what belongs to a gate stands in braces after its name, or below it and deeper"),
        false => problem.propose(format!("indent it, and what belongs to the gate, deeper than `{}`", gate.key), edits),
    }
}

/// `- gates:` after a component that has no gates: its `-` starts a new component.
pub(in crate::parse) fn gates_after_dash(
    item: &Node,
    fields: &Fields<'_>,
    above: Option<&ComponentModel>,
    source: &SourceFile,
) -> Option<Diagnostic> {
    let above = above.filter(|component| component.gates.is_empty() && !component.gates_unread)?;
    let [gates] = fields.list.as_slice() else { return None };
    if gates.key != "gates" {
        return None;
    }
    let name = &above.name.value;
    let message = format!("these `gates` belong to component `{name}`, but their `-` starts a new component");
    let problem = RULE
        .at(message, head(item, fields, source), "a component of its own")
        .label(above.name.span, "the component above");
    let start = with_dash(item.span, source).start;
    let dash = Span { start, end: start + 1, ..item.span };
    Some(problem.propose("replace the `-` by a space", [Edit::new(dash, " ")]))
}

fn problem(message: String, key: Span, source: &SourceFile) -> Diagnostic {
    let line = source.line_range(key.start as usize);
    let before = source.text().get(line.start..key.start as usize).unwrap_or("");
    let label = match before.chars().all(|c| c == ' ') {
        true if before.is_empty() => "at column 1".to_owned(),
        true if before.len() == 1 => "indented by 1 space".to_owned(),
        true => format!("indented by {} spaces", before.len()),
        false => "not here".to_owned(),
    };
    RULE.at(message, key, label)
}

fn in_gate(field: Field<'_>) -> String {
    format!("options stand in the braces of a gate, after its kind: `name: {{kind: type, {}: ...}}`", field.key)
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
                error: [SCL0214] `connections` belongs at the top level, not inside component `sensor`
                 --> topology.yaml:8:5
                  |
                8 |     connections:
                  |     ^^^^^^^^^^^ indented by 4 spaces
                  |
                  = help: move it to column 1"#]],
        );
    }
}
