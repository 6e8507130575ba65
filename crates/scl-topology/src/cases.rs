//! Test cases for every check, as data in `tests/cases`: a text and the problems found in it. Each is tested in several
//! spellings.
//!
//! ```text
//! # SCL0505                          the check that the cases below are about
//! -- pub and pub                     a case and its title
//! @a | x: pub; w: sub                short for a component with its gates
//! @- a.x, b.x                        short for a connection; every other line is the file's
//! => SCL0505 [a.x, b.x]              each problem and the text at its place; none if nothing is found
//! ```
//!
//! `UPDATE_EXPECT=1` rewrites the problems. Lints, and the warnings that small files cannot avoid, are left out unless
//! the case is about them.

mod file;
pub(crate) mod flow;
mod verdicts;

use crate::check::testing::{USUAL, problems};
use crate::diagnostic::{Diagnostic, Severity};
use crate::source::Sources;
use file::Case;

const FILES: [&str; 8] = ["text", "shape", "names", "gates", "connections", "types", "graph", "comments"];
const FEWEST: usize = 540;

/// The messages that the schema of the cases declares.
const MESSAGES: [&str; 3] = ["uav.Command", "uav.Measurement", "uav.Status"];

#[test]
fn every_case_in_three_spellings() {
    let (mut cases, mut in_flow) = (0, 0);
    let mut differences = Vec::new();
    for name in FILES {
        let path = format!("{}/tests/cases/{name}.txt", env!("CARGO_MANIFEST_DIR"));
        let written = std::fs::read_to_string(&path).unwrap();
        let mut out = String::new();
        for case in file::read(&written) {
            in_flow += usize::from(compare_spellings(&case, &mut differences));
            cases += 1;
            case.write(&outcome(&case.code, &case.text), &mut out);
        }
        expect_test::expect_file![path].assert_eq(&out);
    }
    println!("{cases} cases, {in_flow} of them in flow style too");
    assert!(differences.is_empty(), "{}", differences.join("\n"));
    assert!(cases >= FEWEST, "{cases}");
}

/// Checks that a case yields the same problems in every spelling. Returns true if it can be written in flow style.
fn compare_spellings(case: &Case, differences: &mut Vec<String>) -> bool {
    let plain = outcome(&case.code, &case.text);
    for other in [case.text.replace('\n', "\r\n"), case.text.trim_end_matches('\n').to_owned()] {
        if outcome(&case.code, &other) != plain {
            differences.push(format!("{} {}: {other:?}", case.code, case.title));
        }
    }
    let Some(flow) = flow::of(&case.text) else { return false };
    let (in_block, in_flow) = (headlines(&case.code, &case.text), headlines(&case.code, &flow));
    if in_block != in_flow {
        differences.push(format!("{} {}: {flow}{in_block:#?}{in_flow:#?}", case.code, case.title));
    }
    true
}

fn found(code: &str, text: &str) -> (Vec<Diagnostic>, Sources) {
    let (mut found, sources) = problems(text, text.contains("schemas: [uav").then_some(&MESSAGES[..]));
    let is_companion = |found: &Diagnostic| found.severity == Severity::Lint || USUAL.contains(&found.code());
    found.retain(|found| found.code() == code || !is_companion(found));
    (found, sources)
}

/// Code and marked text of each problem.
fn outcome(code: &str, text: &str) -> Vec<String> {
    let (found, sources) = found(code, text);
    let line = |found: &Diagnostic| {
        let marked = found.primary.as_ref().map_or("", |label| sources.snippet(label.span));
        let marked = marked.lines().next().unwrap_or("").trim_end();
        file::hidden(format!("=> {} {marked}", found.code()).trim_end())
    };
    found.iter().map(line).collect()
}

/// Code and headline of each problem, in any order.
fn headlines(code: &str, text: &str) -> Vec<String> {
    let (found, _) = found(code, text);
    let mut lines: Vec<String> = found.iter().map(|found| format!("{} {}", found.code(), found.message)).collect();
    lines.sort();
    lines
}
