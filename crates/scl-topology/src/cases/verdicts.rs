//! Common mistakes, each with the whole text of the messages about it: `tests/cases/verdicts.txt`.
//!
//! A case is a change to the sound file at the top, `old ==> new`, or a separate file with each line after `| `. The
//! text of every error and warning follows.

use crate::check::testing::problems;
use crate::diagnostic::{Severity, render};

const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases/verdicts.txt");

/// Maximum number of errors that one mistake yields.
const MOST_ERRORS: usize = 3;

struct Case {
    title: String,
    /// The lines that make the text, as written.
    lines: Vec<String>,
    text: String,
}

#[test]
fn every_mistake_has_its_text() {
    let file = std::fs::read_to_string(PATH).unwrap();
    let (base, cases) = read(&file);
    assert_eq!(told(&base), "", "the sound file");
    let mut out: String = base.lines().map(|line| format!("| {line}\n")).collect();
    for case in &cases {
        let told = told(&case.text);
        assert_eq!(self::told(&case.text.replace('\n', "\r\n")), told, "{} with other line ends", case.title);
        assert!(told.matches("error: [").count() <= MOST_ERRORS, "{}:\n{told}", case.title);
        out.push_str(&format!("\n-- {}\n", case.title));
        case.lines.iter().for_each(|line| out.push_str(&format!("{line}\n")));
        out.push_str(&told);
    }
    assert!(cases.len() > 150, "{}", cases.len());
    expect_test::expect_file![PATH].assert_eq(&out);
}

fn read(file: &str) -> (String, Vec<Case>) {
    let mut parts = file.split("\n-- ");
    let base: String = parts.next().unwrap().lines().map(own_line).collect();
    let cases = parts.map(|part| case(part, &base)).collect();
    (base, cases)
}

fn case(part: &str, base: &str) -> Case {
    let (title, rest) = part.split_once('\n').unwrap();
    let is_input = |line: &&str| line.starts_with('|') || line.contains(" ==> ");
    let lines: Vec<String> = rest.lines().take_while(is_input).map(str::to_owned).collect();
    let changes: Vec<(&str, &str)> = lines.iter().filter_map(|line| line.split_once(" ==> ")).collect();
    let mut text: String = lines.iter().filter(|line| line.starts_with('|')).map(|line| own_line(line)).collect();
    if !changes.is_empty() {
        base.clone_into(&mut text);
    }
    for (old, new) in changes {
        let (old, new) = (old.replace("\\n", "\n"), new.replace("\\n", "\n"));
        assert!(text.contains(&old), "{title}: {old}");
        text = text.replacen(&old, &new, 1);
    }
    Case { title: title.to_owned(), lines, text }
}

fn own_line(line: &str) -> String {
    format!("{}\n", line.strip_prefix("| ").unwrap_or(""))
}

/// Renders the errors and warnings about a text as users see them.
fn told(text: &str) -> String {
    let (found, sources) = problems(text, None);
    let shown = found.iter().filter(|found| found.severity != Severity::Lint);
    shown.map(|found| format!("{}\n", render(found, &sources).trim_end())).collect()
}
