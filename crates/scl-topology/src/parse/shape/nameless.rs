//! SCL0208: a component without a name.

use super::shift;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::entry::Entry;
use crate::parse::field::{Fields, end_with_colon, head};
use crate::parse::shape_word;
use crate::parse::words::COMPONENT_KEYS;
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0208.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0208",
    severity: Severity::Error,
    title: "component without a name",
    explanation: "Connections and programs refer to a component by its name, so each component needs one. Add `name:`.",
    example: " components:
-  - gates:
+  - name: sensor
+    gates:
       - measurements: pub
",
};

fn nameless(entry: Entry, at: Span, label: impl Into<String>) -> Diagnostic {
    RULE.at(format!("this {} has no name", entry.word()), at, label)
}

fn form(entry: Entry) -> String {
    format!("a {} starts with `- name:` and its name, which connections and programs refer to", entry.word())
}

pub(in crate::parse) fn diagnose(item: &Node, fields: &Fields<'_>, entry: Entry, source: &SourceFile) -> Diagnostic {
    let problem = nameless(entry, head(item, fields, source), "`name` is missing").otherwise(form(entry));
    match fields.list.first() {
        // `- sensor:`, as in a mapping of names.
        Some(first) if !COMPONENT_KEYS.contains(&first.key) && (first.value.is_null() || fields.list.len() == 1) => {
            let colon = Span { end: end_with_colon(first.key_span, source), ..first.key_span };
            let name = first.key;
            let edit = Edit::new(colon, format!("name: {name}"));
            let mut edits = vec![edit];
            if let NodeKind::Mapping { entries } = &first.value.kind
                && let Some((below, _)) = entries.first()
            {
                let deeper = source.column(below.span.start).saturating_sub(source.column(colon.start));
                let block = Span { start: colon.end, ..first.value.span };
                edits.extend(shift::outdented(block, deeper, false, source).unwrap_or_default());
            }
            problem.propose(format!("write `- name: {name}`"), edits)
        }
        _ => problem,
    }
}

/// Keys of a component with no `- name:` above them.
pub(in crate::parse) fn above(key: Span) -> Diagnostic {
    let entry = Entry::Component;
    nameless(entry, key, "`- name: ...` is missing above this").help(form(entry))
}

/// `- sensor` or a list in the place of a component.
pub(in crate::parse) fn not_a_mapping(item: &Node, entry: Entry, source: &SourceFile) -> Diagnostic {
    let label = format!("{}, where the keys of a {} are expected", shape_word(item), entry.word());
    let problem = nameless(entry, item.span, label);
    match &item.kind {
        NodeKind::Scalar { text, .. } if !text.contains('\n') => {
            let name = text.trim();
            let head = shift::head(item.span.start, source);
            let component = match head.contains(['[', ',']) {
                true => format!("{{name: {name}, gates: []}}"),
                false => format!("name: {name}\n{}gates: []", " ".repeat(source.column(item.span.start))),
            };
            let text = format!("write `- name: {name}`, and below it `gates:`");
            problem.suggest(text, [Edit::new(item.span, component)]).otherwise(form(entry))
        }
        _ => problem.help(form(entry)),
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
                error: [SCL0208] this component has no name
                 --> topology.yaml:2:3
                  |
                2 |   - gates:
                  |   ^^^^^^^ `name` is missing
                  |
                  = help: a component starts with `- name:` and its name, which connections and programs refer to"#]],
        );
    }
}
