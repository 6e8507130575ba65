//! Texts and their trees.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::source::Sources;
use expect_test::{Expect, expect};

fn dump(node: &Node, sources: &Sources, depth: usize, out: &mut String) {
    let place = format!("{}{:?}", "  ".repeat(depth), sources.snippet(node.span));
    match &node.kind {
        NodeKind::Scalar { text, style } => out.push_str(&format!("{place} {style:?} {text:?}\n")),
        NodeKind::Unread => out.push_str(&format!("{place} unread\n")),
        NodeKind::Sequence { items } => {
            out.push_str(&format!("{place} list\n"));
            items.iter().for_each(|item| dump(item, sources, depth + 1, out));
        }
        NodeKind::Mapping { entries } => {
            out.push_str(&format!("{place} mapping\n"));
            for (key, value) in entries {
                dump(key, sources, depth + 1, out);
                dump(value, sources, depth + 2, out);
            }
        }
    }
}

fn check(text: &str, expected: Expect) {
    let mut sources = Sources::new();
    let file = sources.add("t.yaml", text);
    let tree = read(sources.file(file).text(), file, false);
    let mut out = String::new();
    if let Some(root) = &tree.root {
        dump(root, &sources, 0, &mut out);
    }
    if let Some(error) = &tree.error {
        out.push_str(&format!("error at {}: {:?}, {}\n", error.at, error.kind, error.words));
    }
    expected.assert_eq(&out);
}

#[test]
fn block_collections_end_with_their_last_child() {
    check(
        "a:\n  - b: c\n  - \"d\"\n\n# end\ne:\n",
        expect![[r#"
        "a:\n  - b: c\n  - \"d\"\n\n# end\ne" mapping
          "a" Plain "a"
            "- b: c\n  - \"d\"" list
              "b: c" mapping
                "b" Plain "b"
                  "c" Plain "c"
              "\"d\"" Quoted "d"
          "e" Plain "e"
            "" Plain ""
    "#]],
    );
}

#[test]
fn flow_collections_end_with_their_bracket() {
    check(
        "{a: [b, 'ä', c: d], e: {}} # end\n",
        expect![[r#"
        "{a: [b, 'ä', c: d], e: {}}" mapping
          "a" Plain "a"
            "[b, 'ä', c: d]" list
              "b" Plain "b"
              "'ä'" Quoted "ä"
              "c: d" mapping
                "c" Plain "c"
                  "d" Plain "d"
          "e" Plain "e"
            "{}" mapping
    "#]],
    );
}

#[test]
fn a_syntax_error_keeps_what_stands_before_it() {
    check(
        "a:\n  - b: c\n    d: [e, f\n  - g\n",
        expect![[r#"
        "a:\n  - b: c\n    d: [e" mapping
          "a" Plain "a"
            "- b: c\n    d: [e" list
              "b: c\n    d: [e" mapping
                "b" Plain "b"
                  "c" Plain "c"
                "d" Plain "d"
                  "[e" list
                    "e" Plain "e"
        error at 19: Other, unclosed bracket '['
    "#]],
    );
    check(
        "a: {b: c, d",
        expect![[r#"
        "a: {b: c" mapping
          "a" Plain "a"
            "{b: c" mapping
              "b" Plain "b"
                "c" Plain "c"
        error at 3: Other, unclosed bracket '{'
    "#]],
    );
    check(
        "a: b: c",
        expect![[r#"
        "a: b" mapping
          "a" Plain "a"
            "b" Plain "b"
        error at 4: Other, mapping values are not allowed in this context
    "#]],
    );
    check(
        "a:\n  b:\n c: d",
        expect![[r#"
        "a:\n  b" mapping
          "a" Plain "a"
            "b" mapping
              "b" Plain "b"
                "" Plain ""
        error at 9: Other, while parsing a block mapping, did not find expected key
    "#]],
    );
}

#[test]
fn lone_and_empty_texts() {
    check("", expect![[r#""#]]);
    check("# only\n", expect![[r#""#]]);
    check(
        "---\n",
        expect![[r#"
        "" Plain ""
    "#]],
    );
    check(
        "~",
        expect![[r#"
        "~" Plain "~"
    "#]],
    );
}

#[test]
fn block_scalars_end_with_their_text() {
    check(
        "a: |\n  text\n  more\n\nb: c\n",
        expect![[r#"
            "a: |\n  text\n  more\n\nb: c" mapping
              "a" Plain "a"
                "text\n  more" Block "text\nmore\n"
              "b" Plain "b"
                "c" Plain "c"
        "#]],
    );
}
