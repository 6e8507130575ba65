//! SCL0107: a key is written twice. SCL0120: a key that is no plain word.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity, removal};
use crate::parse::field::Field;
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0107.
pub(crate) const DUPLICATE: Rule = Rule {
    code: "SCL0107",
    severity: Severity::Error,
    title: "duplicate key",
    explanation: "The same key is written twice in one mapping. YAML tools disagree on which one wins, and some say \
                  nothing about it. Merge the two values, or remove one.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
-    gates:
       - status: pub
",
};

/// A key that is written twice; `first` is the first time, with its value. `owner` says whose key it is, for example
/// `this component`.
pub(in crate::parse) fn duplicate(
    second: &Field<'_>,
    (first, first_entry): (Span, Span),
    owner: &str,
    source: &SourceFile,
) -> Diagnostic {
    let message = format!("the key `{}` is written twice in {owner}", second.key);
    let problem = DUPLICATE.at(message, second.key_span, "second time").label(first, "first time");
    let problem = match second.value.kind {
        NodeKind::Sequence { .. } if second.key == "gates" => problem
            .help("the second list belongs to another component if its `- name` is missing, else to the first list"),
        NodeKind::Sequence { .. } => problem.help("the items of both lists belong into one"),
        NodeKind::Mapping { .. } => problem.help("the entries of both belong into one"),
        _ => problem,
    };
    let entry = second.key_span.to(second.value.span);
    let is_same = source.snippet(entry) == source.snippet(first_entry);
    let ways = [("remove the second one", entry), ("remove the first one", first_entry)];
    let ways = ways.into_iter().filter(|(_, entry)| is_same || !has_entries(*entry, source));
    let removals = ways.filter_map(|(help, entry)| Some((help, removal(source, entry)?)));
    let problem = match merged(second, source).filter(|_| !is_same) {
        Some(edit) => {
            problem.suggest(format!("remove this line with `{}:`, so that both lists become one", second.key), [edit])
        }
        None => problem,
    };
    removals
        .fold(problem, |problem, (help, removed)| problem.suggest(help, [removed]))
        .note("YAML tools disagree which one wins: PyYAML silently keeps the second")
}

/// Whether a key has a list or a mapping with something in it, which would be lost without it.
fn has_entries(entry: Span, source: &SourceFile) -> bool {
    let value = source.snippet(entry).split_once(':').map_or("", |(_, value)| value.trim());
    !matches!(value, "[]" | "{}") && (value.contains('\n') || value.starts_with(['[', '{', '-']))
}

/// Removes the line of a key alone, so that the list below it continues the one above it.
fn merged(second: &Field<'_>, source: &SourceFile) -> Option<Edit> {
    let text = source.text();
    let line = source.line_range(second.key_span.start as usize);
    let is_alone = text[line.clone()].trim().strip_suffix(':') == Some(second.key);
    let end = line.end + text[line.end..].find('\n')? + 1;
    let is_list = matches!(second.value.kind, NodeKind::Sequence { .. });
    (is_alone && is_list).then(|| Edit::new(source.span(line.start..end), ""))
}

/// SCL0120.
pub(crate) const NOT_A_WORD: Rule = Rule {
    code: "SCL0120",
    severity: Severity::Error,
    title: "key is not a plain word",
    explanation: "YAML allows lists, mappings and null as keys. In a topology, each key is a plain word. Write one.",
    example: " components:
-  - ? [a, b]
-    : pub
+  - name: sensor
+    gates:
+      - measurements: pub
+connections: []
",
};

pub(in crate::parse) fn not_a_word(key: &Node) -> Diagnostic {
    let label = format!("this key is {}", crate::parse::shape_word(key));
    NOT_A_WORD.at("a key must be a plain word", key.span, label)
}

#[cfg(test)]
mod tests {
    use super::{DUPLICATE, NOT_A_WORD};
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn duplicate_key() {
        check(
            &DUPLICATE,
            expect![[r#"
                error: [SCL0107] the key `gates` is written twice in this component
                 --> topology.yaml:5:5
                  |
                3 |     gates:
                  |     ----- first time
                4 |       - measurements: pub
                5 |     gates:
                  |     ^^^^^ second time
                  |
                  = help: the second list belongs to another component if its `- name` is missing, else to the first list
                  = help: remove this line with `gates:`, so that both lists become one
                  = note: YAML tools disagree which one wins: PyYAML silently keeps the second"#]],
        );
    }

    #[test]
    fn odd_key() {
        check(
            &NOT_A_WORD,
            expect![[r#"
            error: [SCL0120] a key must be a plain word
             --> topology.yaml:2:7
              |
            2 |   - ? [a, b]
              |       ^^^^^^ this key is a list"#]],
        );
    }
}
