//! The catalogue as text for people: one entry for the terminal, all of them for the documentation.

use super::{ALL, find};
use crate::check::{Facts, SchemaMessages, check};
use crate::diagnostic::{Diagnostics, Rule, Severity, render};
use crate::parse::parse;
use crate::socket_paths::SocketPaths;
use crate::source::Sources;

/// The messages that the schema of the examples declares.
const MESSAGES: [&str; 3] = ["uav.Command", "uav.Measurement", "uav.Status"];

/// Returns the entry of one code as Markdown, or `None` if no rule has the code. Case is ignored.
///
/// ```
/// use scl_topology::catalogue::explain;
///
/// assert!(explain("scl0502").is_some_and(|text| text.starts_with("# SCL0502 unknown gate (error)")));
/// assert_eq!(explain("SCL9999"), None);
/// ```
pub fn explain(code: &str) -> Option<String> {
    find(code).map(|rule| format!("# {}", entry_of(rule)))
}

/// All entries as one page of Markdown: `docs/diagnostics.md`.
pub fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    page.push_str("\n| code | level | check |\n|---|---|---|\n");
    for rule in ALL.iter() {
        page.push_str(&format!("| {} | {} | {} |\n", rule.code, level(rule), rule.title));
    }
    for rule in ALL.iter() {
        page.push_str(&format!("\n## {}", entry_of(rule)));
    }
    page
}

const INTRODUCTION: &str = "# Diagnostics

The mistakes that the checker of topology files finds. The macro `scl::topology!` and `scl check` print the same words.
`scl explain SCL0502` prints an entry. This page is made from the checker itself; `UPDATE_EXPECT=1 cargo test -p
scl-topology` rewrites it.

A comment on the line of a warning or above it allows the warning: `# scl: allow(SCL0701) reason`. The errors SCL0703
and SCL0707 can be allowed in the same way. `# scl: warn(SCL0511)` turns on a check that is off, for the whole file.
";

fn level(rule: &Rule) -> &'static str {
    match rule.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Lint => "off",
    }
}

/// The entry of a rule about a topology or about Rust code.
fn entry_of(rule: &Rule) -> String {
    match rule.has_topology() {
        true => entry(rule, "yaml", |text| told(rule.code, text)),
        false => entry(rule, "rust", |_| String::new()),
    }
}

/// Returns the entry of a rule as Markdown, without the `#` of its heading. `language` is the language of the examples;
/// `told` returns the messages about the wrong example, or an empty text.
pub fn entry(rule: &Rule, language: &str, told: impl Fn(&str) -> String) -> String {
    let level = if rule.severity == Severity::Lint { "lint, off unless asked for" } else { level(rule) };
    let mut text = format!("{} {} ({level})\n\n{}\n", rule.code, rule.title, rule.explanation);
    if rule.example.is_empty() {
        return text;
    }
    let (bad, good) = (rule.bad_example(), rule.good_example());
    text.push_str(&format!("\nWrong:\n\n```{language}\n{}```\n", visible(&bad)));
    let told = told(&bad);
    if !told.is_empty() {
        text.push_str(&format!("\n```text\n{told}\n```\n"));
    }
    text.push_str(&format!("\nRight:\n\n```{language}\n{good}```\n"));
    text
}

/// Makes tabs and no-break spaces visible, which would be lost in a page.
fn visible(text: &str) -> String {
    text.replace('\t', "<TAB>").replace('\u{a0}', "<U+00A0>")
}

/// Renders the problems with this code that the checker finds in an example.
fn told(code: &str, text: &str) -> String {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let mut problems = Diagnostics::new();
    let model = parse(&sources, file, &mut problems);
    let messages = SchemaMessages { names: MESSAGES.map(str::to_owned).to_vec(), ..SchemaMessages::default() };
    let messages = (!model.schemas.is_empty()).then(|| vec![messages]);
    let facts =
        Facts { default_system: "topology".to_owned(), messages, sockets: SocketPaths::example(), ..Facts::default() };
    check(&model, &facts, &sources, &mut problems);
    let found = problems.into_sorted();
    let texts = found.iter().filter(|problem| problem.code() == code).map(|problem| render(problem, &sources));
    texts.collect::<Vec<_>>().join("\n\n")
}
