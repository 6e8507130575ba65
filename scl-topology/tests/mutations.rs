//! Sound files with one token deleted, doubled or misspelt. Each mutant is told on the line of the mutation, or the
//! checker proves that it is still a topology; no mutant makes a panic, and few make more than one error.

use scl_topology::check::{Facts, SchemaMessages, check};
use scl_topology::diagnostic::{Diagnostic, Diagnostics, Severity};
use scl_topology::parse::parse;
use scl_topology::source::Sources;
use std::ops::Range;

const FILES: [(&str, &str); 3] = [
    ("listing_1", include_str!("files/listing_1.yaml")),
    ("rover", include_str!("files/rover.yaml")),
    ("system", include_str!("files/system.yaml")),
];

/// What the schema of the rover declares.
const MESSAGES: [&str; 5] = ["rover.Measurement", "rover.Setpoint", "rover.Event", "rover.Command", "rover.Status"];

/// Whether a topology comes out; errors and warnings with the lines of their places, the own first.
fn problems(text: &str) -> (bool, Vec<(Diagnostic, Vec<u32>)>) {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let mut problems = Diagnostics::new();
    let model = parse(&sources, file, &mut problems);
    let messages = SchemaMessages { names: MESSAGES.map(str::to_owned).to_vec() };
    let messages = (!model.schemas.is_empty()).then(|| vec![messages]);
    let topology =
        check(&model, &Facts { default_system: "t".to_owned(), messages, ..Facts::default() }, &sources, &mut problems);
    let found = problems.into_sorted().into_iter().filter(|found| found.severity != Severity::Lint);
    let lines = |found: &Diagnostic| {
        let labels = found.primary.iter().chain(&found.secondary);
        labels.map(|at| sources.file(at.span.file).line_column(at.span.start).line).collect()
    };
    (topology.is_some(), found.map(|found| (found.clone(), lines(&found))).collect())
}

/// Words and single marks outside of comments; spaces at the start of a line are a token too.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let mut tokens = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split(" #").next().unwrap_or(line);
        let code = if code.starts_with('#') { "" } else { code.trim_end() };
        let mut at = 0;
        while let Some(first) = code[at..].chars().next() {
            let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
            let same = |letter: char| match first {
                ' ' => letter == ' ',
                _ => is_word(first) && is_word(letter),
            };
            let length = code[at..].find(|letter| !same(letter)).unwrap_or(code.len() - at).max(1);
            if first != ' ' || at == 0 {
                tokens.push(start + at..start + at + length);
            }
            at += length;
        }
        start += line.len();
    }
    tokens
}

/// What is done to a token.
fn mutants(text: &str, token: &Range<usize>) -> Vec<(&'static str, String)> {
    let word = &text[token.clone()];
    let with = |other: &str| format!("{}{other}{}", &text[..token.start], &text[token.end..]);
    let mut mutants = vec![("deleted", with("")), ("doubled", with(&format!("{word}{word}")))];
    if word.starts_with(|letter: char| letter.is_alphanumeric() || letter == '_') {
        mutants.push(("misspelt", with(&format!("{}q{}", &word[..1], &word[1..]))));
        mutants.push(("cut", with(&word[..word.len() - 1])));
    }
    mutants
}

#[derive(Default)]
struct Tally {
    all: usize,
    /// Another topology, as good as the first.
    valid: usize,
    /// The place of a problem is on the line.
    on_line: usize,
    /// A problem elsewhere shows the line, as it does where a declaration is misspelt and its use is not.
    shown: usize,
    elsewhere: Vec<String>,
    cascades: Vec<String>,
}

fn judge(name: &str, what: &str, text: &str, token: &Range<usize>, mutant: &str, tally: &mut Tally) {
    let line = text[..token.start].matches('\n').count() as u32 + 1;
    let (is_valid, found) = problems(mutant);
    let told = || found.iter().map(|(found, at)| format!("{} {at:?}", found.code())).collect::<Vec<_>>().join(", ");
    let place = || format!("{name}:{line} `{}` {what}: {}", &text[token.clone()], told());
    tally.all += 1;
    if found.iter().any(|(_, at)| at.first() == Some(&line)) {
        tally.on_line += 1;
    } else if found.iter().any(|(_, at)| at.contains(&line)) {
        tally.shown += 1;
    } else if is_valid && found.is_empty() {
        tally.valid += 1;
    } else {
        tally.elsewhere.push(place());
    }
    if found.iter().filter(|(found, _)| found.severity == Severity::Error).count() > 2 {
        tally.cascades.push(place());
    }
}

#[test]
fn every_mutation_is_told_on_its_line_or_is_a_topology() {
    let mut tally = Tally::default();
    for (name, text) in FILES {
        assert_eq!(problems(text).1, [], "{name} is sound");
        for token in tokens(text) {
            for (what, mutant) in mutants(text, &token) {
                judge(name, what, text, &token, &mutant, &mut tally);
            }
        }
    }
    let Tally { all, valid, on_line, shown, elsewhere, cascades } = &tally;
    let share = |part: usize| 100.0 * part as f64 / (all - valid) as f64;
    println!(
        "{all} mutants: {valid} are topologies; of the others {:.1} % are told on their line, {:.1} % show it, {} are told \
         elsewhere; {} have more than two errors",
        share(*on_line),
        share(*shown),
        elsewhere.len(),
        cascades.len()
    );
    assert!(elsewhere.is_empty(), "told elsewhere:\n{}", elsewhere.join("\n"));
    assert!(cascades.is_empty(), "more than two errors:\n{}", cascades.join("\n"));
    assert!(*all > 2_500 && share(*on_line) > 85.0, "{all} mutants, {:.1} %", share(*on_line));
}
