//! SCL0214: a key that belongs elsewhere.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::model::ComponentModel;
use crate::parse::field::{Field, Fields, head};
use crate::parse::words::{COMPONENT_KEYS, SECTIONS, is_kind, is_option};
use crate::parse::{scalar, with_dash};
use crate::source::{SourceFile, Span};
use crate::yaml::Node;

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

/// A key of a component, or of a gate, at the top level.
pub(in crate::parse) fn at_top(field: Field<'_>, source: &SourceFile) -> Option<Diagnostic> {
    let key = field.key;
    if COMPONENT_KEYS.contains(&key) {
        let message = format!("`{key}` belongs inside a component, not at the top level");
        return Some(problem(message, field.key_span, source).help("indent it below the `- name:` of its component"));
    }
    let message = format!("`{key}` belongs inside a gate, not at the top level");
    is_option(key).then(|| problem(message, field.key_span, source).help(in_gate(field)))
}

/// A section, or an option of a gate, in a component.
pub(in crate::parse) fn in_component(field: Field<'_>, component: &str, source: &SourceFile) -> Option<Diagnostic> {
    let key = field.key;
    if SECTIONS.contains(&key) {
        let message = format!("`{key}` belongs at the top level, not inside component `{component}`");
        return Some(problem(message, field.key_span, source).help("move it to column 1"));
    }
    let message = format!("`{key}` belongs inside a gate, not beside the gates of component `{component}`");
    is_option(key).then(|| problem(message, field.key_span, source).help(in_gate(field)))
}

/// `- measurements: pub` with `queue: 4` below it.
pub(in crate::parse) fn option_beside_gate(option: Field<'_>, gate: Field<'_>, source: &SourceFile) -> Diagnostic {
    let message = format!("`{}` belongs inside the braces of gate `{}`, not beside it", option.key, gate.key);
    let kind = scalar(gate.value).filter(|kind| is_kind(&kind.value)).map_or("pub".to_owned(), |kind| kind.value);
    problem(message, option.key_span, source).help(format!("write `{}: {{{kind}: , {}: ...}}`", gate.key, option.key))
}

/// A gate whose dash stands in the column of the components' dashes.
pub(in crate::parse) fn gate_among_components(item: &Node, above: &ComponentModel, source: &SourceFile) -> Diagnostic {
    let name = source.snippet(item.span);
    let name = name.split([':', '\n']).next().unwrap_or("");
    let start = with_dash(item.span, source);
    let end = item.span.start + name.len() as u32;
    let message = format!("gate `{name}` stands among the components");
    let problem = RULE.at(message, Span { end, ..start }, "starts a component of its own");
    match above.gates.last() {
        Some(gate) => problem
            .label(gate.name.span, "the gate above")
            .help(format!("indent it like the gates of component `{}`", above.name.value)),
        None => problem.help(format!("indent it below the `gates:` of component `{}`", above.name.value)),
    }
}

/// `- measurements:` with `pub: Type` below it, in the same column as the name.
pub(in crate::parse) fn kind_beside_name(kind: Field<'_>, gate: Field<'_>, source: &SourceFile) -> Diagnostic {
    let message = format!("`{}` stands beside the name of gate `{}`, not below it", kind.key, gate.key);
    problem(message, kind.key_span, source)
        .label(gate.key_span, "the gate's name")
        .help(format!("indent it, and what belongs to the gate, deeper than `{}`", gate.key))
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
    Some(
        RULE.at(message, head(item, fields, source), "a component of its own")
            .label(above.name.span, "the component above")
            .help("replace the `-` by a space"),
    )
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
    format!("write it into the braces of a gate: `- name: {{pub: Type, {}: ...}}`", field.key)
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
