//! Helpers for the tests of the rules: a text goes in, the messages that users read come out.

use super::{Facts, SchemaMessages, check_with_parts, find, without_repeats};
use crate::advice::{ChangedCopy, Extent, Judged, try_advice_in_files};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity, render};
use crate::groups::{Group, Scope, flatten};
use crate::join::join;
use crate::model::Model;
use crate::parse::{Part, complete, parse_part};
use crate::socket_paths::SocketPaths;
use crate::source::{FileId, SourceFile, Sources};
use crate::topology::Topology;
use expect_test::Expect;
use std::sync::Arc;

/// The warnings that small examples cannot avoid: no connections, and gates without a peer.
pub(crate) const USUAL: [&str; 7] = ["SCL0206", "SCL0209", "SCL0701", "SCL0702", "SCL0703", "SCL0704", "SCL0705"];

/// Checks the text of an example's problems, with either line end.
#[track_caller]
pub(crate) fn example(code: &str, yaml: &str, expected: Expect) {
    example_with(code, yaml, None, expected);
}

/// Checks the text of the problems in the bad example of a rule.
#[track_caller]
pub(crate) fn rule_example(rule: &Rule, expected: Expect) {
    example(rule.code, &bad(rule), expected);
}

/// As [`rule_example`], for an example whose schemas declare these messages.
#[track_caller]
pub(crate) fn rule_example_with(rule: &Rule, messages: Option<&[&str]>, expected: Expect) {
    example_with(rule.code, &bad(rule), messages, expected);
}

#[track_caller]
fn bad(rule: &Rule) -> String {
    assert!(rule.has_topology(), "{} has no topology as its example", rule.code);
    rule.bad_example()
}

/// As [`example`], for a file whose schemas declare these messages.
#[track_caller]
pub(crate) fn example_with(code: &str, yaml: &str, messages: Option<&[&str]>, expected: Expect) {
    let text = told(code, yaml, messages);
    assert_eq!(text, told(code, &yaml.replace('\n', "\r\n"), messages), "line ends change the words");
    expected.assert_eq(&text);
}

fn told(code: &str, yaml: &str, messages: Option<&[&str]>) -> String {
    let (found, sources) = problems(yaml, messages);
    let is_usual = |found: &Diagnostic| USUAL.contains(&found.code()) || found.severity == Severity::Lint;
    let told = found.iter().filter(|found| found.code() == code || !is_usual(found));
    let texts: Vec<String> = told.map(|found| render(found, &sources)).collect();
    format!("{}\n", texts.join("\n\n").trim_end())
}

/// The codes of all problems but lints, in the order of their places.
pub(crate) fn codes(yaml: &str) -> Vec<&'static str> {
    let (found, _) = problems(yaml, None);
    found.into_iter().filter(|found| found.severity != Severity::Lint).map(|found| found.code()).collect()
}

/// Headlines and helps of all errors, in one line.
pub(crate) fn advice(yaml: &str) -> String {
    let (found, _) = problems(yaml, None);
    let errors = found.iter().filter(|found| found.severity == Severity::Error && found.code() != "SCL0703");
    let told = errors.map(|found| {
        let helps: Vec<_> = found.shown_helps().map(|help| help.text()).collect();
        format!("{} {} [{}]", found.code(), found.message, helps.join(" | "))
    });
    told.collect::<Vec<_>>().join("; ")
}

/// As [`advice`], for errors and warnings of one rule, in a file whose schemas declare these messages.
pub(crate) fn advice_with(rule: &Rule, yaml: &str, messages: &[&str]) -> String {
    let (found, _) = problems(yaml, Some(messages));
    let told = found.iter().filter(|found| found.code() == rule.code).map(|found| {
        let helps: Vec<_> = found.shown_helps().map(|help| help.text()).collect();
        format!("{} [{}]", found.message, helps.join(" | "))
    });
    told.collect::<Vec<_>>().join("; ")
}

/// A line for each pair of a sender and a receiver: what these rules say of the file that `file` makes of them.
pub(crate) fn advice_of_pairs(rules: &[&Rule], pairs: &[(&str, &str)], file: impl Fn(&str, &str) -> String) -> String {
    let line = |(sender, receiver): &(&str, &str)| {
        let yaml = file(sender, receiver);
        let found: String = rules.iter().map(|rule| advice_with(rule, &yaml, &["T"])).collect();
        format!("{sender} -> {receiver}: {found}\n")
    };
    pairs.iter().map(line).collect()
}

/// All problems of a text, and its sources.
pub(crate) fn problems(yaml: &str, messages: Option<&[&str]>) -> (Vec<Diagnostic>, Sources) {
    let (_, found, sources) = run(yaml, messages);
    (found, sources)
}

/// As [`problems`], for a topology file, which is the first, and files that it includes.
pub(crate) fn problems_in_files(files: &[(&str, &str)], messages: Option<&[&str]>) -> (Vec<Diagnostic>, Sources) {
    let (_, found, sources) = run_files(files, messages);
    (found, sources)
}

/// The topology of a text without errors.
#[track_caller]
pub(crate) fn topology(yaml: &str) -> Topology {
    let (topology, found, sources) = run(yaml, None);
    let texts: Vec<String> = found.iter().map(|found| render(found, &sources)).collect();
    topology.unwrap_or_else(|| panic!("{}", texts.join("\n")))
}

fn run(yaml: &str, messages: Option<&[&str]>) -> (Option<Topology>, Vec<Diagnostic>, Sources) {
    run_files(&[("topology.yaml", yaml)], messages)
}

/// The files that the first one includes, joined with it or as groups.
fn scope(sources: &Sources, files: &[FileId], problems: &mut Diagnostics) -> Scope {
    let mut scope = Scope { model: parse_part(sources, files[0], Part::Main, problems), groups: Vec::new() };
    let parts = files[1..].iter().map(|file| {
        let model = parse_part(sources, *file, Part::Included, problems);
        (sources.file(*file).path(), *file, Arc::new(Scope { model, groups: Vec::new() }))
    });
    for (path, file, part) in parts.collect::<Vec<_>>() {
        let entries: Vec<_> = scope.model.include.iter().filter(|entry| entry.file.value == path).cloned().collect();
        for entry in entries {
            let scope_of_file = Arc::clone(&part);
            match entry.group {
                Some(name) => scope.groups.push(Group { name, file, stem: "file".to_owned(), scope: scope_of_file }),
                None => join(&mut scope.model, scope_of_file.model.clone(), problems),
            }
        }
    }
    scope
}

fn written_out(scope: &Scope, sources: &Sources, problems: &mut Diagnostics) -> Model {
    let mut model = flatten(scope.clone(), sources, problems);
    complete(&mut model, sources, problems);
    model
}

/// The facts about a file whose schemas declare these messages.
fn facts(messages: Option<&[&str]>) -> Facts {
    let declared = |names: &[&str]| SchemaMessages {
        names: names.iter().map(|&name| name.to_owned()).collect(),
        enums: [("uav.Mode".to_owned(), vec!["uav.Status".to_owned()])].into(),
        ..SchemaMessages::default()
    };
    let messages = messages.map(|names| vec![declared(names)]);
    Facts { default_system: "topology".to_owned(), messages, sockets: SocketPaths::example(), ..Facts::default() }
}

fn run_files(files: &[(&str, &str)], messages: Option<&[&str]>) -> (Option<Topology>, Vec<Diagnostic>, Sources) {
    let mut sources = Sources::new();
    let files: Vec<FileId> = files.iter().map(|(name, text)| sources.add(*name, *text)).collect();
    let facts = facts(messages);
    let judge = |sources: &Sources| {
        let mut problems = Diagnostics::new();
        let scope = scope(sources, &files, &mut problems);
        let (mut of_parts, mut found) = (Diagnostics::new(), Diagnostics::new());
        let mut groups: Vec<&Group> = scope.groups.iter().collect();
        groups.dedup_by_key(|group| group.file);
        let parts: Vec<Model> =
            groups.into_iter().map(|group| written_out(&group.scope, sources, &mut of_parts)).collect();
        let model = written_out(&scope, sources, &mut found);
        without_repeats(&mut found, &mut of_parts, &parts);
        problems.append(of_parts);
        problems.append(found);
        let (topology, problems) = check_with_parts(&model, &parts, &facts, sources, problems);
        assert_eq!(
            topology.is_none(),
            problems.iter().any(|problem| problem.severity == Severity::Error),
            "a topology comes out exactly when there is no error: {}",
            sources.file(files[0]).text()
        );
        (topology, Judged { problems, extent: Extent::of(&model) })
    };
    let (topology, mut found) = judge(&sources);
    let all: Vec<&SourceFile> = files.iter().map(|file| sources.file(*file)).collect();
    try_advice_in_files(&mut found, &all, |copies| judge(&ChangedCopy::replace_in(copies, &sources)).1);
    let found = found.problems;
    let unlisted = found.iter().find(|found| find(found.code()).is_none());
    assert!(unlisted.is_none(), "the rule of this problem is missing from the list of its stage: {unlisted:?}");
    (topology, found, sources)
}
