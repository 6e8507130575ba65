//! Diagnostics and their text.

use super::{render, render_headless, render_styled};
use crate::diagnostic::testing::{ERROR, WARNING};
use crate::external::{FILE_NOT_FOUND, SCHEMA};
use crate::source::{FileId, Sources, Span};
use expect_test::{Expect, expect};

/// A diagnostic at the first place of a word.
fn at(sources: &Sources, file: FileId, word: &str) -> Span {
    let start = sources.file(file).text().find(word).map_or(0, |found| found as u32);
    Span { file, start, end: start + word.len() as u32 }
}

fn check(text: &str, primary: &str, secondary: &[&str], expected: Expect) {
    let mut sources = Sources::new();
    let file = sources.add("dir/topology.yaml", text);
    let mut problem = ERROR.at("a headline", at(&sources, file, primary), "why here");
    for word in secondary {
        problem = problem.label(at(&sources, file, word), "also");
    }
    expected.assert_eq(&render(&problem.help("one\ntwo").note("the rule"), &sources));
}

#[test]
fn two_places_far_apart() {
    let text = "a: 1\nb: 2\nc: 3\nd: 4\ne: 5\nf: 6\n";
    check(
        text,
        "f",
        &["b"],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:6:1
          |
        2 | b: 2
          | - also
        ...
        6 | f: 6
          | ^ why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
    check(
        &text.replace('\n', "\r\n"),
        "f",
        &["b"],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:6:1
          |
        2 | b: 2
          | - also
        ...
        6 | f: 6
          | ^ why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
}

#[test]
fn columns_count_characters_and_carets_count_cells() {
    check(
        "名前: 漢字 x # end",
        "漢字",
        &["x"],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:1:5
          |
        1 | 名前: 漢字 x # end
          |       ^^^^ - also
          |       |
          |       why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
    check(
        "a:\tb\tc",
        "b",
        &["c"],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:1:4
          |
        1 | a:    b    c
          |       ^    - also
          |       |
          |       why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
    check(
        "e\u{301}: x",
        "x",
        &[],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:1:5
          |
        1 | é: x
          |    ^ why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
}

#[test]
fn points_and_ends_of_lines() {
    check(
        "a:\r\nb:",
        "",
        &[],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:1:1
          |
        1 | a:
          | ^ why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
    check(
        "",
        "",
        &[],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:1:1
          |
        1 |
          | ^ why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
    check(
        "a:\r\nb: c\r\n",
        "a:\r\nb",
        &[],
        expect![[r#"
        error: [SCL0999] a headline
         --> dir/topology.yaml:1:1
          |
        1 | a:
          | ^^ why here
          |
          = help: one
                  two
          = note: the rule"#]],
    );
}

#[test]
fn a_label_in_another_file() {
    let mut sources = Sources::new();
    let yaml = sources.add("topology.yaml", "schemas: [a.proto]\n");
    let proto = sources.add("a.proto", "syntax = \"proto3\";\nmessage A {\n");
    let problem = SCHEMA
        .at("the schema does not compile", at(&sources, proto, "{"), "not closed")
        .label(at(&sources, yaml, "a.proto"), "named here");
    expect![[r#"
        error: [SCL0406] the schema does not compile
         --> a.proto:2:11
          |
        2 | message A {
          |           ^ not closed
          |
         ::: topology.yaml:1:11
          |
        1 | schemas: [a.proto]
          |           ------- named here"#]]
    .assert_eq(&render(&problem, &sources));
}

#[test]
fn without_a_place() {
    let problem = FILE_NOT_FOUND.without_place("no \u{1b}[31m file\nhere").help("look");
    expect![[r#"
        error: [SCL0001] no \u{1b}[31m file\nhere
         |
         = help: look"#]]
    .assert_eq(&render(&problem, &Sources::new()));
}

#[test]
fn headless_starts_with_the_code() {
    let mut sources = Sources::new();
    let file = sources.add("t.yaml", "a: b");
    let problem = WARNING.at("a [headline]", at(&sources, file, "b"), "");
    expect![[r#"
        [SCL0999] a [headline]
         --> t.yaml:1:4
          |
        1 | a: b
          |    ^"#]]
    .assert_eq(&render_headless(&problem, &sources));
    assert!(render_styled(&problem, &sources).contains("\u{1b}["));
}

#[test]
fn a_line_of_a_mebibyte_is_cut() {
    let text = format!("a: {}X{}", "b".repeat(500_000), "c".repeat(500_000));
    let mut sources = Sources::new();
    let file = sources.add("t.yaml", text);
    let problem = ERROR.at("long", at(&sources, file, "X"), "here");
    let rendered = render(&problem, &sources);
    assert!(rendered.len() < 2_000, "{} bytes", rendered.len());
    assert!(rendered.contains("t.yaml:1:500004") && rendered.contains("^ here"), "{rendered}");
}
