//! Whatever the text: no panic, every problem can be shown, and the time grows with the text and no faster.

use scl_topology::diagnostic::{Diagnostic, Diagnostics, MOST_SHOWN, limit, render};
use scl_topology::model::Model;
use scl_topology::parse::parse;
use scl_topology::source::Sources;

const VALID: [&str; 3] =
    [include_str!("files/listing_1.yaml"), include_str!("files/every_key.yaml"), include_str!("files/flow.json")];

fn run(text: &str) -> (Model, Vec<Diagnostic>) {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let mut problems = Diagnostics::new();
    let model = parse(&sources, file, &mut problems);
    let problems = problems.into_sorted();
    for problem in limit(problems.clone(), MOST_SHOWN, "topology.yaml") {
        assert!(render(&problem, &sources).contains(problem.code()));
    }
    (model, problems)
}

/// Words, spaces, and single marks, each with its place.
fn tokens(text: &str) -> Vec<(usize, &str)> {
    let mut tokens: Vec<(usize, &str)> = Vec::new();
    let kind = |c: char| {
        if c.is_alphanumeric() || c == '_' {
            0
        } else if c == ' ' {
            1
        } else {
            2
        }
    };
    let mut start = 0;
    let characters: Vec<(usize, char)> = text.char_indices().collect();
    for pair in characters.windows(2) {
        let ((_, before), (at, after)) = (pair[0], pair[1]);
        if kind(before) != kind(after) || kind(after) == 2 {
            tokens.push((start, &text[start..at]));
            start = at;
        }
    }
    tokens.push((start, &text[start..]));
    tokens
}

#[test]
fn valid_files_have_no_problem() {
    for text in VALID {
        assert_eq!(run(text).1, [], "{text}");
    }
}

/// What is put in the place of a token, or after it. One in [`STEP`] is tried at each token, as a text with a syntax
/// error is read many times.
const STEP: usize = 4;

#[test]
fn any_token_deleted_doubled_or_replaced() {
    const OTHERS: [&str; 16] =
        ["", "\t", "\0", "\u{a0}", "@", "\"", "[", "}", ": ", "- ", "\n", "*", "&a ", "é", "<<", "? "];
    for text in VALID {
        for (number, (at, token)) in tokens(text).into_iter().enumerate() {
            let (before, after) = (&text[..at], &text[at + token.len()..]);
            for other in OTHERS.into_iter().skip(number % STEP).step_by(STEP) {
                run(&format!("{before}{other}{after}"));
                run(&format!("{before}{token}{other}{after}"));
            }
            run(&format!("{before}{token}{token}{after}"));
            run(before);
            run(after);
        }
    }
}

#[test]
fn deep_nesting_is_one_problem() {
    for text in ["[".repeat(5_000), "{a: ".repeat(5_000), "- ".repeat(5_000), "? ".repeat(5_000)] {
        let (model, problems) = run(&format!("components: {text}"));
        assert!(model.cut_off);
        assert!(!problems.is_empty() && problems.len() < 3, "{problems:?}");
    }
    let blocks: String = (0..5_000).map(|depth| format!("{}a:\n", " ".repeat(depth))).collect();
    let problems = run(&blocks).1;
    assert_eq!(problems.iter().map(|problem| problem.code()).collect::<Vec<_>>(), ["SCL0116"]);
}

#[test]
fn one_long_line() {
    const SIZE: usize = 1 << 13;
    for unit in [
        "a", "a ", "[", "]", "{", "\"", "'", "\\", ":", "a:", "a: ", "- ", "-", "#", "\t", "\0", "\u{feff}", "é",
        "&a ", "*a ", "!", "%", "@", "|", ">", "[a,", "{a: b},", "\r", "? ", "[]", "a: 'b", "\"\\",
    ] {
        run(&unit.repeat(SIZE / unit.len()));
        run(&format!("components: {}", unit.repeat(SIZE / unit.len())));
        run(&format!("components: [{}", unit.repeat(SIZE / unit.len())));
    }
}

#[test]
fn a_mebibyte() {
    for unit in ["a", "[", "# scl: ", "\"", "- ", "\t", "\0", "&a ", "a: b: "] {
        run(&format!("components: {}", unit.repeat((1 << 20) / unit.len())));
    }
    for unit in
        ["\t- a\n", "---\n", "%A\n", "# scl: allow(SCL0701)\n", "# scl:\n", "- a:b\n", "? a\n", "  - [a\n", "\r"]
    {
        run(&format!("components:\n{}", unit.repeat((1 << 20) / unit.len())));
    }
}

#[test]
fn many_short_lines() {
    const SIZE: usize = 1 << 13;
    for unit in [
        "a\n",
        "- a\n",
        "a:\n",
        "- a: b\n",
        "#\n",
        "\n",
        "\r\n",
        "\t- a\n",
        "  - [a\n",
        "  - \"a\n",
        "- a:b\n",
        "---\n",
        "? a\n",
        "- *a\n",
        "- &a b\n",
        "- !a b\n",
        " - a\n- b\n",
        "%A\n",
        "a: |\n",
        "a: b: c\n",
        "- {a: b\n",
    ] {
        run(&unit.repeat(SIZE / unit.len()));
        run(&format!("components:\n{}", unit.repeat(SIZE / unit.len())));
        run(&format!("connections:\n{}", unit.repeat(SIZE / unit.len())));
    }
}

#[test]
fn a_hundred_thousand_gates() {
    let gates: String = (0..100_000).map(|number| format!("      - gate_{number}: pub\n")).collect();
    let (model, problems) = run(&format!("components:\n  - name: big\n    gates:\n{gates}connections: []\n"));
    assert_eq!(problems, []);
    assert_eq!(model.components[0].gates.len(), 100_000);
}
