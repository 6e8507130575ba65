//! The Rust code of the pages is taken from programs that are compiled and tested: the templates, and the examples of
//! the quick start.

use crate::{files_below, read};

const PAGES: [&str; 5] = ["tutorial", "your-own-project", "testing", "shutdown", "threads"];

const SOURCES: [&str; 4] = [
    "crates/scl-new/templates/control/src",
    "crates/scl-new/templates/control/tests",
    "crates/scl-new/templates/minimal/src",
    "examples/quickstart/examples",
];

#[test]
fn listings_are_excerpts_of_programs() {
    let sources = SOURCES.iter().flat_map(|folder| files_below(folder, "rs"));
    let programs: Vec<String> = sources.map(|file| plain_lines(&read(&file))).collect();
    for page in PAGES {
        let text = read(&format!("docs/{page}.md"));
        let listings: Vec<String> = listings(&text).map(plain_lines).collect();
        assert!(!listings.is_empty(), "docs/{page}.md has no listing");
        for listing in listings {
            let found = programs.iter().any(|program| program.contains(&listing));
            assert!(found, "docs/{page}.md: no program contains\n{listing}");
        }
    }
}

fn listings(page: &str) -> impl Iterator<Item = &str> {
    page.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next())
}

/// The lines without their indentation, each between line ends.
fn plain_lines(text: &str) -> String {
    let lines = text.trim().lines().map(|line| format!("{}\n", line.trim()));
    std::iter::once("\n".to_owned()).chain(lines).collect()
}
