//! The page is current, complete, and every example on it is a sound topology.

use super::{entries, explain, page};
use crate::check::testing::{USUAL, problems, problems_in_files};
use crate::diagnostic::{Severity, render};

/// The texts between ```` ```yaml ```` and ```` ``` ````.
fn examples(markdown: &str) -> Vec<&str> {
    markdown.split("```yaml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

/// A whole file from a part of one: a list of gates, or a section.
fn completed(example: &str) -> String {
    const COMPONENT: &str = "components:\n  - name: example\n    gates:\n";
    match example {
        gates if gates.starts_with("- ") => {
            COMPONENT.to_owned() + &gates.lines().map(|line| format!("      {line}\n")).collect::<String>()
        }
        file if file.contains("components:") => file.to_owned(),
        section => format!("{section}{COMPONENT}      - x: pub\n"),
    }
}

/// Checks an example, together with the examples that are files which it includes: their first line is the name.
#[track_caller]
fn assert_sound(example: &str, others: &[&str]) {
    let text = completed(example);
    let included = others.iter().filter_map(|other| {
        let name = other.strip_prefix("# ")?.lines().next()?;
        let is_included = example.contains(&format!("include: [{name}]")) || example.contains(&format!("file: {name}"));
        is_included.then_some((name, *other))
    });
    let files: Vec<(&str, &str)> = std::iter::once(("topology.yaml", text.as_str())).chain(included).collect();
    let (found, sources) = problems_in_files(&files, None);
    let problem = found.iter().find(|it| it.severity != Severity::Lint && !USUAL.contains(&it.rule.code));
    assert!(problem.is_none(), "{}", render(problem.unwrap(), &sources));
}

#[test]
fn every_example_is_sound() {
    let page = page();
    assert!(examples(&page).len() > 10);
    let all = examples(&page);
    all.iter().for_each(|example| assert_sound(example, &all));
    for entry in entries() {
        assert_eq!(examples(&entry.text).len(), 1, "{}", entry.word);
        examples(&entry.text).into_iter().for_each(|example| assert_sound(example, &[]));
    }
}

#[test]
fn the_whole_example_has_no_warning() {
    let (found, sources) = problems(examples(&page())[0], None);
    let problem = found.iter().find(|it| it.severity != Severity::Lint);
    assert!(problem.is_none(), "{}", render(problem.unwrap(), &sources));
}

#[test]
fn an_example_shows_its_option() {
    for entry in entries() {
        assert!(entry.text.split("```").nth(1).unwrap().contains(entry.word), "{}", entry.text);
    }
}

#[test]
fn every_word_has_a_summary_of_one_sentence() {
    for entry in entries() {
        let (summary, word) = (entry.summary, entry.word);
        assert!(!summary.is_empty() && summary.len() < 120 && !summary.contains(". "), "{word}: {summary}");
        assert!(page().contains(summary), "{word}");
    }
}

#[test]
fn a_word_with_two_meanings_has_both() {
    let text = explain("codec").unwrap();
    assert!(text.contains("# codec (section)") && text.contains("# codec (option)"), "{text}");
    assert!(!text.contains("](#") && !text.contains("\n\n\n"), "{text}");
}

#[test]
fn the_page_in_the_repository_is_current() {
    let page = page();
    assert!(!page.contains('{') || !page.contains("_entries}"), "a mark is left");
    expect_test::expect_file!["../../../../../docs/topology.md"].assert_eq(&page);
}
