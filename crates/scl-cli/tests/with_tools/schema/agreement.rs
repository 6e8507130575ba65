//! The schema accepts what the checker accepts, and refuses what the checker refuses for its look. A language server
//! judges; it reads the schema as any other.

#[allow(dead_code, reason = "the cases of the checker are only read here")]
#[path = "../../../../scl-topology/src/cases/file.rs"]
mod file;

use super::{language_server, schema, serve};
use crate::system::System;
use scl_needs::needs;
use scl_topology::catalogue::ALL;
use scl_topology::check::{Facts, check};
use scl_topology::diagnostic::{Diagnostics, Severity};
use scl_topology::grammar::{COMPONENT_KEYS, GateKind, OPTIONS, SECTIONS, page};
use scl_topology::parse::parse;
use scl_topology::source::Sources;
use std::path::{Path, PathBuf};

/// Values of every look.
const VALUES: [&str; 22] = [
    "", "~", "''", "many", "5", "'5'", "0", "-1", "1.5", "true", "'true'", "yes", "500ms", "1 s", "5 min", "8MiB",
    "8MB", "wait", "ok", "json", "[1]", "{a: 1}",
];

/// The codes of errors about the look of a value: nothing, the wrong kind, a key that is not known here.
const LOOKS: [&str; 7] = ["SCL0110", "SCL0204", "SCL0205", "SCL0212", "SCL0213", "SCL0215", "SCL0408"];

/// The codes of the errors that the checker finds.
fn errors(text: &str) -> Vec<&'static str> {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let mut problems = Diagnostics::new();
    let model = parse(&sources, file, &mut problems);
    check(&model, &Facts { default_system: "t".to_owned(), ..Facts::default() }, &sources, &mut problems);
    let found = problems.into_sorted().into_iter().filter(|found| found.severity == Severity::Error);
    found.map(|found| found.rule.code).collect()
}

/// For each text, whether the language server finds nothing.
fn accepted(texts: &[String]) -> Vec<bool> {
    let program = language_server();
    let system = System::of_files(&[("topology.yaml", super::ROVER)]);
    let mut server = serve(&system, &program);
    system.write("topology.schema.json", &schema(&system, &[]).to_string());
    let paths: Vec<PathBuf> = (0..texts.len()).map(|at| system.path(&format!("{at}.yaml"))).collect();
    for (path, text) in paths.iter().zip(texts) {
        server.open(path, "yaml", &format!("# yaml-language-server: $schema=topology.schema.json\n{text}"));
    }
    server.counts_of_diagnostics(&paths).into_iter().map(|count| count == 0).collect()
}

/// Every topology of the project that has its place in a file.
fn topologies() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let cases = std::fs::read_dir(root.join("crates/scl-topology/tests/cases")).unwrap();
    // The verdicts are whole files in a format of their own.
    let cases = cases.map(|entry| entry.unwrap().path()).filter(|path| !path.ends_with("verdicts.txt"));
    let cases = cases.flat_map(|path| file::read(&std::fs::read_to_string(path).unwrap()));
    let mut texts: Vec<String> = cases.map(|case| case.text).collect();
    let examples = ALL.iter().filter(|rule| rule.has_topology());
    texts.extend(examples.flat_map(|rule| [rule.bad_example(), rule.good_example()]));
    let page = page();
    let blocks = page.split("```yaml\n").skip(1).map(|rest| rest.split("```").next().unwrap().to_owned());
    texts.extend(blocks.filter(|block| block.contains("components:")));
    texts.push("include: [sensors.yaml, {file: arm.yaml, as: left_arm}]\n".to_owned());
    for folder in ["crates/scl-topology/tests/files", "examples", "ui-tests", "tests", "scl"] {
        read_files(&root.join(folder), &mut texts);
    }
    texts
}

fn read_files(folder: &Path, texts: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let is_topology = path.extension().is_some_and(|ending| ending == "yaml" || ending == "json");
        match path.is_dir() {
            true => read_files(&path, texts),
            false if is_topology => texts.extend(std::fs::read_to_string(&path)),
            false => {}
        }
    }
}

#[needs("node", "npm")]
#[test]
fn the_schema_accepts_every_valid_topology_of_the_project() {
    let valid: Vec<String> = topologies().into_iter().filter(|text| errors(text).is_empty()).collect();
    assert!(valid.len() > 250, "{}", valid.len());
    let accepted = accepted(&valid);
    let refused: Vec<&String> = valid.iter().zip(accepted).filter(|(_, is_fine)| !is_fine).map(|(it, _)| it).collect();
    assert!(refused.is_empty(), "{} of {}: {refused:#?}", refused.len(), valid.len());
}

/// Every key with values of every look: options at a kind that has them and at one that does not.
fn variants() -> Vec<String> {
    let mut texts = Vec::new();
    for value in VALUES {
        for option in OPTIONS {
            let other = GateKind::ALL.into_iter().find(|&kind| !option.fits(kind));
            for kind in option.kinds.iter().take(1).copied().chain(other) {
                let payload = if kind.exchanges() { "A -> B" } else { "T" };
                let options = if option.key == "unconnected" { "" } else { ", unconnected: ok" };
                let gate = format!("x: {{{}: {payload}, {}: {value}{options}}}", kind.word(), option.key);
                texts.push(format!("components:\n  - name: a\n    gates:\n      - {gate}\n"));
            }
        }
        for key in &COMPONENT_KEYS {
            let name = if key.key == "name" { "" } else { "name: a, " };
            texts.push(format!("components: [{{{name}{}: {value}}}]\n", key.key));
        }
        for section in &SECTIONS {
            let rest = if section.key == "components" { "" } else { "components: []\n" };
            texts.push(format!("{}: {value}\n{rest}", section.key));
        }
    }
    texts
}

#[needs("node", "npm")]
#[test]
fn the_schema_and_the_checker_agree_on_the_look_of_values() {
    let texts = variants();
    let accepted = accepted(&texts);
    let (mut fine, mut wrong, mut differ) = (0, 0, Vec::new());
    for (text, is_accepted) in texts.iter().zip(accepted) {
        let errors = errors(text);
        let is_refused_for_its_look = errors.iter().any(|code| LOOKS.contains(code));
        fine += usize::from(errors.is_empty());
        wrong += usize::from(is_refused_for_its_look);
        if errors.is_empty() && !is_accepted || is_refused_for_its_look && is_accepted {
            differ.push(format!("{text}  {errors:?}, the schema {}", if is_accepted { "accepts" } else { "refuses" }));
        }
    }
    println!("{fine} values are right, {wrong} have the wrong look");
    assert!(differ.is_empty() && fine > 50 && wrong > 200, "{fine} {wrong}\n{}", differ.join("\n"));
}
