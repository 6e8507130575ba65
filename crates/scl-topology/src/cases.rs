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

use crate::check::testing::{USUAL, problems_in_files};
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

/// A file that another one includes has the same problems, and so has a file whose connections stand in another one.
#[test]
fn every_case_in_an_included_file() {
    let mut differences = Vec::new();
    let mut split = 0;
    for name in FILES {
        let path = format!("{}/tests/cases/{name}.txt", env!("CARGO_MANIFEST_DIR"));
        for case in file::read(&std::fs::read_to_string(&path).unwrap()) {
            let has_setting = ["system", "codec"].iter().any(|key| section(&case.text, key).is_some());
            if WHOLE_FILES.contains(&case.code.as_str()) || has_setting {
                continue;
            }
            let told = |main: &str, included: &str| {
                let files = [("topology.yaml", main), ("included.yaml", included)];
                headlines_in(&case.code, &files)
            };
            let alone = headlines(&case.code, &case.text);
            let mut compare = |how: &str, other: Vec<String>| {
                if other != alone {
                    differences.push(format!("{how} {} {}: {}{alone:#?}{other:#?}", case.code, case.title, case.text));
                }
            };
            compare("included", told("include: [included.yaml]\n", &case.text));
            if let Some(at) = section(&case.text, "connections") {
                let (before, connections) = case.text.split_at(at);
                compare("split", told(&format!("include: [included.yaml]\n{connections}"), before));
                split += 1;
            }
        }
    }
    println!("{split} cases in two files");
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

/// A file that becomes a group has the same problems, told once and in its own words, and so has one that becomes two.
#[test]
fn every_case_in_a_group() {
    let mut differences = Vec::new();
    for name in FILES {
        let path = format!("{}/tests/cases/{name}.txt", env!("CARGO_MANIFEST_DIR"));
        for case in file::read(&std::fs::read_to_string(&path).unwrap()) {
            let has_setting = ["system", "codec"].iter().any(|key| section(&case.text, key).is_some());
            // Several groups may be islands.
            if WHOLE_FILES.contains(&case.code.as_str()) || has_setting || case.code == "SCL0706" {
                continue;
            }
            let alone = headlines(&case.code, &case.text);
            for groups in [&["left"][..], &["left", "right"]] {
                let entries = groups.iter().map(|group| format!("  - {{file: part.yaml, as: {group}}}\n"));
                let main = format!("include:\n{}", entries.collect::<String>());
                let mut other = headlines_in(&case.code, &[("topology.yaml", &main), ("part.yaml", &case.text)]);
                // `left._left` is `left__left` in C++.
                other.retain(|line| !(line.contains("._left`") && line.contains("two underscores")));
                if other != alone {
                    let (code, title, text) = (&case.code, &case.title, &case.text);
                    differences.push(format!("{groups:?} {code} {title}: {text}{alone:#?}{other:#?}"));
                }
            }
        }
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

/// Checks about what a whole file lacks.
const WHOLE_FILES: [&str; 4] = ["SCL0203", "SCL0205", "SCL0206", "SCL0115"];

/// Where a section begins in block style.
fn section(text: &str, key: &str) -> Option<usize> {
    let line = format!("{key}:");
    if text.starts_with(&line) { Some(0) } else { text.find(&format!("\n{line}")).map(|at| at + 1) }
}

fn found(code: &str, files: &[(&str, &str)]) -> (Vec<Diagnostic>, Sources) {
    let has_schemas = files.iter().any(|(_, text)| text.contains("schemas: [uav"));
    let (mut found, sources) = problems_in_files(files, has_schemas.then_some(&MESSAGES[..]));
    let is_companion = |found: &Diagnostic| found.severity == Severity::Lint || USUAL.contains(&found.code());
    found.retain(|found| found.code() == code || !is_companion(found));
    (found, sources)
}

/// Code and marked text of each problem.
fn outcome(code: &str, text: &str) -> Vec<String> {
    let (found, sources) = found(code, &[("topology.yaml", text)]);
    let line = |found: &Diagnostic| {
        let marked = found.primary.as_ref().map_or("", |label| sources.snippet(label.span));
        let marked = marked.lines().next().unwrap_or("").trim_end();
        file::hidden(format!("=> {} {marked}", found.code()).trim_end())
    };
    found.iter().map(line).collect()
}

/// Code and headline of each problem, in any order.
fn headlines(code: &str, text: &str) -> Vec<String> {
    headlines_in(code, &[("topology.yaml", text)])
}

fn headlines_in(code: &str, files: &[(&str, &str)]) -> Vec<String> {
    let (found, _) = found(code, files);
    let mut lines: Vec<String> = found.iter().map(|found| format!("{} {}", found.code(), found.message)).collect();
    lines.sort();
    lines
}
