//! What a topology should have and lacks. SCL0203: the section `components`. SCL0205: components. SCL0206: connections.
//! SCL0209: gates of a component.

use super::option_value::filled;
use super::shift;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::entry::Entry;
use crate::parse::field::{Field, Fields};
use crate::source::{SourceFile, Span, Spanned};
use scl_text::list::quoted_list;

/// SCL0203.
pub(crate) const SECTION: Rule = Rule {
    code: "SCL0203",
    severity: Severity::Error,
    title: "required section missing",
    explanation: "The section `components` declares the components and their gates; everything else in the file refers \
                  to them. Add it.",
    example: "-connections:
-  - [sensor.measurements, controller.sensor]
+components: []
+connections: []
",
};

pub(in crate::parse) fn section(fields: &Fields<'_>, source: &SourceFile) -> Diagnostic {
    const MESSAGE: &str = "the section `components` is missing";
    const SHOWN: usize = 6;
    let keys: Vec<&str> = fields.list.iter().map(|field| field.key).collect();
    let first = fields.list.first().map_or(source.span(0..0), |field| field.key_span);
    let label = match keys.len() {
        0 => "this file has no section".to_owned(),
        count if count > SHOWN => {
            format!("this file has only {} and {} more", quoted_list(&keys[..SHOWN]), count - SHOWN)
        }
        _ => format!("this file has only {}", quoted_list(keys)),
    };
    SECTION.at(MESSAGE, first, label).help("the section `components` declares each component and its gates")
}

/// SCL0205.
pub(crate) const COMPONENTS: Rule = Rule {
    code: "SCL0205",
    severity: Severity::Error,
    title: "no components",
    explanation: "The section `components` has no entry. Add at least one component; if the file is meant to be empty, \
                  write `components: []`.",
    example: "-components:
+components: []
 connections: []
",
};

/// A section `components` without a value. An explicit `components: []` is accepted, as it is for gates and
/// connections.
pub(in crate::parse) fn components(section: Field<'_>, source: &SourceFile) -> Diagnostic {
    COMPONENTS
        .at("the topology has no components", section.key_span, "the section is empty")
        .help("each component is an item of the list below it, with a `name` and its `gates`")
        .suggest("if there are none yet, write `components: []`", [filled(section, "[]", source)])
}

/// SCL0206.
pub(crate) const CONNECTIONS: Rule = Rule {
    code: "SCL0206",
    severity: Severity::Warning,
    title: "no connections",
    explanation: "Gates are declared, but none of them is connected. Add the section `connections`. To connect them \
                  later, write `connections: []` for now.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
+connections: []
",
};

/// Returns a warning if gates exist, and `connections` is missing or has no value. An explicit `connections: []` is
/// accepted.
pub(in crate::parse) fn find_connections(
    components: Field<'_>,
    connections: Option<Field<'_>>,
    gates: usize,
    source: &SourceFile,
) -> Option<Diagnostic> {
    if gates == 0 || connections.is_some_and(|section| !section.value.is_null()) {
        return None;
    }
    let label =
        if gates == 1 { "1 gate is declared here".to_owned() } else { format!("{gates} gates are declared here") };
    let problem = CONNECTIONS.at("the topology has no connections", components.key_span, label);
    const FORM: &str =
        "`connections` lists the pairs of gates that are connected: `- [component.gate, component.gate]`";
    const LATER: &str = "if the gates are connected later, write `connections: []`";
    let end = source.text().len();
    let text = if source.text().ends_with('\n') { "connections: []\n" } else { "\nconnections: []\n" };
    let (problem, edit) = match connections {
        Some(section) => (problem.label(section.key_span, "empty"), filled(section, "[]", source)),
        None => (problem, Edit::new(source.span(end..end), text)),
    };
    Some(problem.help(FORM).suggest(LATER, [edit]))
}

/// SCL0209.
pub(crate) const GATES: Rule = Rule {
    code: "SCL0209",
    severity: Severity::Warning,
    title: "component without gates",
    explanation: "A component without gates cannot communicate, so it is probably unfinished. Add a gate, or remove \
                  the component; if it is meant to have none, write `gates: []`.",
    example: " components:
   - name: logger
-    gates:
+    gates: []
",
};

/// Returns a warning if `gates` is missing or has no value. An explicit `gates: []` is accepted.
pub(in crate::parse) fn find_gates(
    component: &Spanned<String>,
    gates: Option<Field<'_>>,
    entry: Entry,
    source: &SourceFile,
) -> Option<Diagnostic> {
    if gates.is_some_and(|field| !field.value.is_null()) {
        return None;
    }
    let message = format!("{} `{}` has no gates", entry.word(), component.value);
    let mut problem = GATES.at(message, component.span, "it cannot be part of any connection");
    if let Some(gates) = gates {
        let span = Span { end: gates.key_span.end + 1, ..gates.key_span };
        problem = problem.label(span, "empty");
    }
    let edit = gates.map_or_else(|| without_gates(component.span, source), |gates| filled(gates, "[]", source));
    let form = "each gate is an item of the list `gates`: `- name: kind`";
    Some(problem.help(form).suggest("if it is meant to have none, write `gates: []`", [edit]))
}

/// The change that gives a component an empty list of gates, after its name.
fn without_gates(name: Span, source: &SourceFile) -> Edit {
    let head = shift::head(name.start, source);
    let column = head.len() - head.trim_start_matches([' ', '-']).len();
    match head.contains(['{', ',']) {
        true => Edit::new(Span { start: name.end, ..name }, ", gates: []"),
        false => {
            let line = source.line_range(name.start as usize).end as u32;
            Edit::new(Span { start: line, end: line, ..name }, format!("\n{}gates: []", " ".repeat(column)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{COMPONENTS, CONNECTIONS, GATES, SECTION};
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn missing_section() {
        check(
            &SECTION,
            expect![[r#"
                error: [SCL0203] the section `components` is missing
                 --> topology.yaml:1:1
                  |
                1 | connections:
                  | ^^^^^^^^^^^ this file has only `connections`
                  |
                  = help: the section `components` declares each component and its gates"#]],
        );
    }

    #[test]
    fn no_components() {
        check(
            &COMPONENTS,
            expect![[r#"
                error: [SCL0205] the topology has no components
                 --> topology.yaml:1:1
                  |
                1 | components:
                  | ^^^^^^^^^^ the section is empty
                  |
                  = help: each component is an item of the list below it, with a `name` and its `gates`
                  = help: if there are none yet, write `components: []`"#]],
        );
    }

    #[test]
    fn no_connections() {
        check(
            &CONNECTIONS,
            expect![[r#"
                warning: [SCL0206] the topology has no connections
                 --> topology.yaml:1:1
                  |
                1 | components:
                  | ^^^^^^^^^^ 1 gate is declared here
                  |
                  = help: `connections` lists the pairs of gates that are connected: `- [component.gate, component.gate]`
                  = help: if the gates are connected later, write `connections: []`"#]],
        );
    }

    #[test]
    fn component_without_gates() {
        check(
            &GATES,
            expect![[r#"
                warning: [SCL0209] component `logger` has no gates
                 --> topology.yaml:2:11
                  |
                2 |   - name: logger
                  |           ^^^^^^ it cannot be part of any connection
                3 |     gates:
                  |     ------ empty
                  |
                  = help: each gate is an item of the list `gates`: `- name: kind`
                  = help: if it is meant to have none, write `gates: []`"#]],
        );
    }
}
