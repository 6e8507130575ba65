//! SCL0204: a section, or the list of gates, has the wrong kind.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::model::ComponentModel;
use crate::parse::field::Field;
use crate::parse::field::end_with_colon;
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
pub(in crate::parse) fn components(section: Field<'_>, first: Option<&ComponentModel>) -> Diagnostic {
    let name = first.map_or("sensor", |component| component.name.value.as_str());
    let gate = first.and_then(|component| component.gates.first());
    let (gate, kind) = match gate {
        Some(gate) if !gate.kind.value.is_empty() => (gate.name.value.as_str(), gate.kind.value.as_str()),
        _ => ("measurements", "pub"),
    };
    let label = format!("a key, where `- name: {name}` is expected");
    let example = format!("write:\ncomponents:\n  - name: {name}\n    gates:\n      - {gate}: {kind}");
    wrong_kind(section, first_key(section.value), label).help(example)
}

/// `gates: {measurements: pub}`.
pub(in crate::parse) fn gates(field: Field<'_>, source: &SourceFile) -> Diagnostic {
    let key = first_key(field.value);
    let name = source.text().get(key.start as usize..key.end as usize).unwrap_or("measurements");
    let span = Span { end: end_with_colon(key, source), ..key };
    let problem = wrong_kind(field, span, format!("a key, where `- {name}: ...` is expected"));
    problem.help(format!("start each gate with `-`: `- {name}: ...`"))
}

/// `connections:` that are no list.
pub(in crate::parse) fn connections(section: Field<'_>) -> Diagnostic {
    wrong_kind(section, first_key(section.value), String::new())
        .help("write:\nconnections:\n  - [sensor.measurements, controller.sensor]")
}

/// `schemas: rover.proto`, `schema_roots: proto`.
pub(in crate::parse) fn files(section: Field<'_>) -> Diagnostic {
    let problem = wrong_kind(section, first_key(section.value), String::new());
    match &section.value.kind {
        NodeKind::Scalar { text, .. } => problem.help(format!("write `{}: [{text}]`", section.key)),
        _ => problem.help("write the paths in brackets: `schemas: [rover.proto]`, `schema_roots: [proto]`"),
    }
}

/// Text where a list belongs.
pub(in crate::parse) fn text(section: Field<'_>) -> Diagnostic {
    wrong_kind(section, section.value.span, String::new())
        .help(format!("write each entry on a line of its own below `{}:`, after a `-`", section.key))
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
              = help: write:
                      components:
                        - name: sensor
                          gates:
                            - measurements: pub"#]],
        );
    }
}
