//! SCL0111: anchors and aliases.

use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::source::{SourceFile, Span};
use crate::yaml::{Anchor, Node, NodeKind, Tree};

/// SCL0111.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0111",
    severity: Severity::Error,
    title: "anchors and aliases are not supported",
    explanation: "YAML can name a value with `&` and repeat it with `*`. A topology is a contract that people read \
                  line by line, and repeated values would make places in messages ambiguous and tiny files enormous. \
                  Write the value out.",
    example: " components:
   - name: a
-    gates: &g
+    gates: 
       - x: pub
   - name: b
-    gates: *g
+    gates:
+      - x: pub
",
};

/// Only the first anchors get a help made for their place, as finding it takes a walk over the whole tree.
const EXPLAINED: usize = 20;

/// Reports each anchor with its aliases, and each alias without an anchor.
pub(super) fn check(tree: &Tree, source: &SourceFile, problems: &mut Diagnostics) {
    for (number, anchor) in tree.anchors.iter().enumerate() {
        let root = tree.root.as_ref().filter(|_| number < EXPLAINED);
        problems.push(diagnose(anchor, root, source));
    }
}

fn diagnose(anchor: &Anchor, root: Option<&Node>, source: &SourceFile) -> Diagnostic {
    const MESSAGE: &str = "YAML anchors and aliases are not supported in a topology";
    let first_use = anchor.aliases.first().copied();
    let mut problem = match (anchor.definition, first_use) {
        (Some(definition), _) => RULE.at(MESSAGE, definition, "anchor defined here"),
        (None, Some(alias)) => RULE.at(MESSAGE, alias, "no anchor of this name stands above"),
        (None, None) => RULE.without_place(MESSAGE),
    };
    if anchor.definition.is_some() {
        for alias in &anchor.aliases {
            problem = problem.label(*alias, "used here");
        }
    }
    let help = match first_use {
        Some(alias) => help(alias, root, source),
        None => "remove it; nothing refers to it".to_owned(),
    };
    problem.help(help).note(
        "a topology is a contract that people read; expanded aliases also make error positions ambiguous and allow \
         \"billion laughs\" files",
    )
}

fn help(alias: Span, root: Option<&Node>, source: &SourceFile) -> String {
    match root.and_then(|root| named_place(root, alias)) {
        Some((key, owner)) => format!("write the {key} of `{owner}` out"),
        None => format!("write the value out in the place of `{}`", source.snippet(alias)),
    }
}

/// The key whose value a node is, and the `name` beside that key. The depth of the tree bounds the recursion.
fn named_place(node: &Node, wanted: Span) -> Option<(&str, &str)> {
    if node.span.start > wanted.start || node.span.end < wanted.end {
        return None;
    }
    match &node.kind {
        NodeKind::Sequence { items } => items.iter().find_map(|item| named_place(item, wanted)),
        NodeKind::Mapping { entries } => {
            let name = entries.iter().find(|(key, _)| text(key) == Some("name")).and_then(|(_, name)| text(name));
            let here = entries.iter().find(|(_, value)| value.span == wanted).and_then(|(key, _)| text(key));
            here.zip(name).or_else(|| entries.iter().find_map(|(_, value)| named_place(value, wanted)))
        }
        _ => None,
    }
}

fn text(node: &Node) -> Option<&str> {
    match &node.kind {
        NodeKind::Scalar { text, .. } => Some(text),
        _ => None,
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
            error: [SCL0111] YAML anchors and aliases are not supported in a topology
             --> topology.yaml:3:12
              |
            3 |     gates: &g
              |            ^^ anchor defined here
            ...
            6 |     gates: *g
              |            -- used here
              |
              = help: write the gates of `b` out
              = note: a topology is a contract that people read; expanded aliases also make error positions ambiguous and allow "billion laughs" files"#]],
        );
    }
}
