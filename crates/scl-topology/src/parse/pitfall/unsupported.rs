//! Parts of YAML that a topology does not have. SCL0111: anchors and aliases. SCL0112: the merge key `<<`. SCL0113: a
//! tag. SCL0114: more than one document. SCL0118: a directive, such as `%YAML 1.1`.

mod merged;
mod not_an_anchor;
mod written_out;

use super::needs_quotes;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::parse::dialect::Dialect;
use crate::source::{SourceFile, Span};
use crate::yaml::{Anchor, MOST_REPEATED, Node, NodeKind, Tree};
use scl_text::list::quoted_list;
use std::ops::Range;

/// SCL0111.
pub(crate) const ANCHOR: Rule = Rule {
    code: "SCL0111",
    severity: Severity::Error,
    title: "anchors and aliases are not supported",
    explanation: "YAML can name a value with `&` and repeat it with `*`. A topology is a contract that people read \
                  line by line; with aliases, messages could not point to one place, and a tiny file could expand to \
                  an enormous one. Write the value out.",
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

/// Number of anchors that get a help made for their place. Finding it takes a walk over the whole tree, so the later
/// ones do without.
const EXPLAINED: usize = 20;

/// Reports each anchor with its aliases, and each alias without an anchor.
pub(super) fn check_anchors(tree: &Tree, source: &SourceFile, problems: &mut Diagnostics) {
    for (number, anchor) in tree.anchors.iter().enumerate() {
        let root = tree.root.as_ref().filter(|_| number < EXPLAINED);
        let other = not_an_anchor::text(anchor, source).or_else(|| not_an_anchor::reference(anchor, source));
        problems.push(other.unwrap_or_else(|| diagnose_anchor(anchor, root, source)));
    }
}

/// Reports each alias that stands for nothing, in a file that may have aliases.
pub(super) fn check_aliases(tree: &Tree, source: &SourceFile, problems: &mut Diagnostics) {
    let undefined = tree.anchors.iter().filter(|anchor| anchor.definition.is_none());
    for alias in undefined.flat_map(|anchor| &anchor.aliases) {
        if let Some(problem) = needs_quotes::at_start(*alias, source) {
            problems.push(problem);
            continue;
        }
        let problem = ANCHOR.at("this alias has no anchor", *alias, "no anchor of this name ends above");
        problems.push(problem.help("write the value out, or put `&` and the name before the value that is meant"));
    }
    problems.extend(tree.too_much.map(|alias| {
        ANCHOR
            .at("the aliases of the file expand to too many values", alias, "not read")
            .help("write the values out")
            .note(format!("together they may expand to at most {MOST_REPEATED} values"))
    }));
}

fn diagnose_anchor(anchor: &Anchor, root: Option<&Node>, source: &SourceFile) -> Diagnostic {
    const MESSAGE: &str = "YAML anchors and aliases are not supported in a topology";
    let first_use = anchor.aliases.first().copied();
    let mut problem = match (anchor.definition, first_use) {
        (Some(definition), _) => ANCHOR.at(MESSAGE, definition, "anchor defined here"),
        (None, Some(alias)) => ANCHOR.at(MESSAGE, alias, "no anchor of this name stands above"),
        (None, None) => ANCHOR.without_place(MESSAGE),
    };
    if anchor.definition.is_some() {
        problem = problem.labels(anchor.aliases.iter().map(|alias| (*alias, "used here")));
    }
    let anchor_help = match first_use {
        Some(alias) => match written_out::merge(alias, source)
            .and_then(|place| Some((place, written_out::keys(anchor, source)?)))
        {
            Some((place, keys)) => {
                format!("write {} in the place of `{}`", quoted_list(&keys), source.snippet(place))
            }
            None => anchor_help(alias, root, source),
        },
        None => "remove it; nothing refers to it".to_owned(),
    };
    let problem = match (anchor.definition, first_use) {
        (Some(definition), None) => {
            let rest = &source.text()[definition.end as usize..];
            let spaces = rest.len() - rest.trim_start_matches(' ').len();
            let removed = Span { end: definition.end + spaces as u32, ..definition };
            problem.propose(anchor_help, [Edit::new(removed, "")])
        }
        // Each edit holds a copy of the value, so the number of anchors with edits is bounded, too.
        _ => match written_out::edits(anchor, source).filter(|_| root.is_some()) {
            Some(edits) => {
                problem.suggest(format!("{anchor_help}, and remove the anchor"), edits).otherwise(anchor_help)
            }
            None => problem.help(anchor_help),
        },
    };
    problem.note(
        "a topology is a contract that people read; expanded aliases also make error positions ambiguous and allow \
         \"billion laughs\" files",
    )
}

fn anchor_help(alias: Span, root: Option<&Node>, source: &SourceFile) -> String {
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

/// SCL0112.
pub(crate) const MERGE_KEY: Rule = Rule {
    code: "SCL0112",
    severity: Severity::Error,
    title: "merge key",
    explanation: "In some YAML tools, `<<` merges the keys of another mapping. It is not part of YAML 1.2, so tools \
                  disagree about it. Write the keys out.",
    example: " components:
   - name: b
-    <<: {gates: []}
+    gates: []
",
};

pub(in crate::parse) fn merge_key(key: &Node, dialect: &Dialect) -> Diagnostic {
    let message = "the merge key `<<` is not supported";
    MERGE_KEY.at(message, key.span, "YAML 1.1 extension, not part of YAML 1.2").help(dialect.instead_of_merge)
}

/// SCL0113.
pub(crate) const TAG: Rule = Rule {
    code: "SCL0113",
    severity: Severity::Error,
    title: "YAML tag",
    explanation: "A tag such as `!!str` changes the type of a value, and in some languages even runs code. A topology \
                  needs none. Remove it.",
    example: " components:
-  - name: !!python/name:os.system sensor
+  - name: sensor
+    gates: []
",
};

pub(super) fn tag(tag: Span, source: &SourceFile, dialect: &Dialect) -> Diagnostic {
    if let Some(problem) = needs_quotes::at_start(tag, source) {
        return problem;
    }
    let rest = &source.text()[tag.end as usize..];
    let spaces = rest.len() - rest.trim_start_matches(' ').len();
    TAG.at(format!("YAML tags are not supported in a {}", dialect.noun), tag, "tag")
        .propose("remove the tag", [Edit::new(Span { end: tag.end + spaces as u32, ..tag }, "")])
}

/// SCL0114.
pub(crate) const SECOND_DOCUMENT: Rule = Rule {
    code: "SCL0114",
    severity: Severity::Error,
    title: "more than one document",
    explanation: "`---` starts another YAML document in the same file. A topology is one document; most tools would \
                  silently ignore the rest. Remove the line.",
    example: " components: []
----
 connections: []
",
};

/// A second document. If it has no `---`, the parser may place its start at its content.
pub(super) fn second_document(source: &SourceFile, at: Span, dialect: &Dialect) -> Diagnostic {
    let rest = source.text().get(at.start as usize..).unwrap_or("");
    let marker = rest.starts_with("---");
    let help = if marker { "remove the `---` line" } else { "remove the `...` line above" };
    let span = if marker { Span { end: at.start + 3, ..at } } else { at };
    let message = format!("a {} is one YAML document; a second one starts here", dialect.noun);
    let problem = SECOND_DOCUMENT.at(message, span, "second document");
    let text = source.text();
    let line = match marker {
        true => Some(at.start as usize),
        false => text[..at.start as usize].rfind("\n...").map(|before| before + 1),
    };
    match line.map(|line| source.line_range(line)) {
        Some(line) => {
            let end = text[line.end..].find('\n').map_or(text.len(), |found| line.end + found + 1);
            let removed = Edit::new(source.span(line.start..end), "");
            match merged::sections(&(line.start..end), source) {
                Some((keys, edits)) => problem.suggest(
                    format!("{help}, and move the entries of {keys} below it to those above"),
                    edits.into_iter().chain([removed]),
                ),
                None => problem.propose(help, [removed]),
            }
            .otherwise("if it is the same system, join both documents: each section stands once in a file")
        }
        None => problem.help(help),
    }
}

/// SCL0118.
pub(crate) const DIRECTIVE: Rule = Rule {
    code: "SCL0118",
    severity: Severity::Error,
    title: "YAML directive",
    explanation: "Lines that start with `%` are directives to the YAML parser. A topology is always read as YAML 1.2, \
                  so it needs none. Remove the line and the `---` below it.",
    example: "-%YAML 1.1
----
 components: []
",
};

/// Reports the directives before the document, and puts spaces in their place.
pub(in crate::parse) fn check_directives(
    source: &SourceFile,
    text: &mut String,
    dialect: &Dialect,
    problems: &mut Diagnostics,
) {
    let directives = leading_directives(text);
    for directive in &directives {
        problems.push(diagnose_directive(source, directive.start, dialect));
        text.replace_range(directive.clone(), &" ".repeat(directive.len()));
    }
}

pub(in crate::parse) fn diagnose_directive(source: &SourceFile, at: usize, dialect: &Dialect) -> Diagnostic {
    let range = source.line_range(at);
    let line = source.line(at);
    if let Some(comment) = source.text()[range.clone()].strip_prefix("% ") {
        let percent = Edit::new(source.span(range.start..range.start + 1), "#");
        let message = "YAML directives are not supported, and a comment starts with `#`";
        let help = format!("write `# {}`", comment.trim_end());
        return DIRECTIVE.at(message, source.span(range), "starts no comment").propose(help, [percent]);
    }
    let marker = source.text()[range.end..].trim_start().starts_with("---");
    let help = if marker { format!("remove lines {line} and {}", line + 1) } else { format!("remove line {line}") };
    let text = source.text();
    let end = range.end + text[range.end..].find('\n').map_or(0, |at| at + 1);
    let with_marker = text[end..].find('\n').filter(|_| marker && text[end..].starts_with("---"));
    let removed = source.span(range.start..end + with_marker.map_or(0, |at| at + 1));
    DIRECTIVE
        .at("YAML directives are not supported", source.span(range), "directive")
        .propose(help, [Edit::new(removed, "")])
        .note(format!("a {} is read as YAML 1.2; see SCL0108 for the words that differ", dialect.noun))
}

/// Lines that start with `%` before anything else than comments.
fn leading_directives(text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.trim_end();
        if content.starts_with('%') {
            found.push(start..start + content.len());
        } else if !content.is_empty() && !content.starts_with('#') {
            break;
        }
        start += line.len();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{ANCHOR, DIRECTIVE, MERGE_KEY, SECOND_DOCUMENT, TAG};
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn anchor_and_alias() {
        check(
            &ANCHOR,
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
                  = help: write the gates of `b` out, and remove the anchor
                  = note: a topology is a contract that people read; expanded aliases also make error positions ambiguous and allow "billion laughs" files"#]],
        );
    }

    #[test]
    fn merge_key() {
        check(
            &MERGE_KEY,
            expect![[r#"
            error: [SCL0112] the merge key `<<` is not supported
             --> topology.yaml:3:5
              |
            3 |     <<: {gates: []}
              |     ^^ YAML 1.1 extension, not part of YAML 1.2
              |
              = help: write the keys out"#]],
        );
    }

    #[test]
    fn tag() {
        check(
            &TAG,
            expect![[r#"
            error: [SCL0113] YAML tags are not supported in a topology
             --> topology.yaml:2:11
              |
            2 |   - name: !!python/name:os.system sensor
              |           ^^^^^^^^^^^^^^^^^^^^^^^ tag
              |
              = help: remove the tag"#]],
        );
    }

    #[test]
    fn second_document() {
        check(
            &SECOND_DOCUMENT,
            expect![[r#"
            error: [SCL0114] a topology is one YAML document; a second one starts here
             --> topology.yaml:2:1
              |
            2 | ---
              | ^^^ second document
              |
              = help: remove the `---` line"#]],
        );
    }

    #[test]
    fn directive() {
        check(
            &DIRECTIVE,
            expect![[r#"
            error: [SCL0118] YAML directives are not supported
             --> topology.yaml:1:1
              |
            1 | %YAML 1.1
              | ^^^^^^^^^ directive
              |
              = help: remove lines 1 and 2
              = note: a topology is read as YAML 1.2; see SCL0108 for the words that differ"#]],
        );
    }
}
