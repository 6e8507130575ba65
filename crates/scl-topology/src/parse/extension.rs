//! Sections of the user's own, such as `x-notes`: their content is not checked, except for keys that are written twice,
//! as YAML tools disagree about these.

use super::field::Field;
use super::{Reader, pitfall};
use crate::source::Span;
use crate::yaml::{Node, NodeKind};
use std::collections::HashMap;

impl Reader<'_> {
    pub(super) fn check_extension(&mut self, section: Field<'_>) {
        let owner = format!("`{}`", section.key);
        let mut open = vec![section.value];
        while let Some(node) = open.pop() {
            match &node.kind {
                NodeKind::Scalar { .. } | NodeKind::Unread => {}
                NodeKind::Sequence { items } => open.extend(items.iter().rev()),
                NodeKind::Mapping { entries } => {
                    self.check_keys(entries, &owner);
                    open.extend(entries.iter().rev().map(|(_, value)| value));
                }
            }
        }
    }

    fn check_keys(&mut self, entries: &[(Node, Node)], owner: &str) {
        let mut seen: HashMap<&str, (Span, Span)> = HashMap::new();
        for (key_node, value) in entries {
            let NodeKind::Scalar { text: key, .. } = &key_node.kind else { continue };
            let first = *seen.entry(key).or_insert((key_node.span, key_node.span.to(value.span)));
            if first.0 != key_node.span {
                let field = Field { key, key_span: key_node.span, key_node, value };
                self.report(pitfall::key::duplicate(&field, first, owner, self.source));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::parse_text;

    #[test]
    fn keys_that_are_written_twice_are_found_at_every_depth() {
        let yaml = "\
components: []
x-notes:
  owner: [a, {b: 1, c: 2, b: 3}]
  deep: {a: {k: 1, k: 2}}
  owner: b
  again: {k: 1}
";
        let (_, problems, sources) = parse_text(yaml);
        let found = problems.iter().filter(|problem| problem.code() == "SCL0107");
        let told: Vec<String> =
            found.filter_map(|problem| problem.primary.as_ref()).map(|label| sources.place(label.span)).collect();
        assert_eq!(told, ["topology.yaml:3:27", "topology.yaml:4:20", "topology.yaml:5:3"]);
    }
}
