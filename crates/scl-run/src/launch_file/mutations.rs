//! Sound launch files with one word, line or character deleted, doubled or misspelt. No mutant makes a panic or more
//! than three errors, each proposal solves its problem and adds no error, and what is sure gives the meaning of the
//! sound file.

use super::super::system_names::SystemNames;
use super::super::system_names::tests::rover;
use super::{EXAMPLE, LaunchDocument};
use scl_topology::advice::apply;
use scl_topology::diagnostic::{Diagnostic, Severity};

const OTHER: &str = "\
topology: topology.yaml
build: cargo build --release
environment: {RUST_LOG: info, PYTHONUNBUFFERED: 1}
components:
  sensor:
    command: [./sensor, --rate, 100]
    ready_within: 5s
    cpu: [2, 3]
  controller:
    build: make -C controller
    command: controller/build/controller --port /dev/ttyS1
    restart: always
    environment:
      GAIN: 0.5
    parameters:
      gain: 1.5
      offsets: [0, 0.1, 0]
  logger:
    command: [python3, logger.py]
    input: terminal
    essential: false
profiles:
  simulation:
    sensor: {command: [python3, sensor.py]}
  flight:
    sensor: {replay: flight.mcap}
transports:
  sensor.measurements: shm
hosts:
  board: {address: 127.0.0.1, port: 7447, components: [sensor, controller]}
  laptop:
    address: 127.0.0.1
    port: 7448
    components:
      - logger
gateway: {certificates: ./keys}
";

/// No mistake makes more errors.
const MOST_ERRORS: usize = 3;

fn names() -> SystemNames {
    let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    let parameters = rover().parameters.remove("controller").unwrap();
    SystemNames {
        parameters: [("controller".to_owned(), parameters)].into(),
        components: owned(&["sensor", "controller", "logger"]),
        gates: owned(&["sensor.measurements", "controller.measurements", "controller.setpoints", "logger.setpoints"]),
        ..SystemNames::default()
    }
}

fn problems(text: &str) -> Vec<Diagnostic> {
    LaunchDocument::parse("launch.yaml", text).check(Some(&names())).1
}

/// What a file means, without the places of its entries; `None` if it has mistakes.
fn meaning(text: &str) -> Option<String> {
    let file = LaunchDocument::parse("launch.yaml", text).read(Some(&names())).ok()?;
    let shown = format!("{file:?}");
    let mut parts = shown.split("place: \"launch.yaml:");
    let first = parts.next().unwrap_or_default().to_owned();
    Some(parts.fold(first, |all, part| all + part.split_once('"').map_or("", |(_, rest)| rest)))
}

/// The words of a text, and its single marks, with their places.
fn tokens(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let is_word = |letter: char| letter.is_alphanumeric() || "_./-".contains(letter);
        let end = text[at..].find(|letter| !is_word(letter)).unwrap_or(text.len() - at);
        let end = at + if is_word(first) { end } else { first.len_utf8() };
        let is_comment = text[..at].rsplit('\n').next().is_some_and(|line| line.contains(" #"));
        if first != '\n' && first != '#' && !is_comment {
            tokens.push(at..end);
        }
        at = end;
    }
    tokens
}

fn mutants(text: &str) -> Vec<String> {
    let with =
        |range: &std::ops::Range<usize>, other: &str| format!("{}{other}{}", &text[..range.start], &text[range.end..]);
    let mut mutants = Vec::new();
    for token in tokens(text) {
        let word = &text[token.clone()];
        mutants.push(with(&token, ""));
        mutants.push(with(&token, &format!("{word}{word}")));
        if word.len() > 2 {
            mutants.push(with(&token, &format!("{}q{}", &word[..1], &word[1..])));
            mutants.push(with(&token, &word[..word.len() - 1]));
        }
    }
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let range = start..start + line.len();
        mutants.push(with(&range, ""));
        mutants.push(with(&range, &format!("{line}{line}")));
        start = range.end;
    }
    mutants
}

/// Whether a change solved a problem without adding one.
fn is_better(before: &[Diagnostic], after: &[Diagnostic], problem: &Diagnostic) -> bool {
    let count = |of: &[Diagnostic], wanted: &Diagnostic| {
        of.iter().filter(|found| found.rule == wanted.rule && found.message == wanted.message).count()
    };
    count(after, problem) < count(before, problem)
        && after.iter().all(|found| count(after, found) <= count(before, found))
}

#[test]
fn advice_about_mutants_of_launch_files_helps() {
    let (mut all, mut proposed, mut sure) = (0, 0, 0);
    let (mut useless, mut wrong, mut cascades) = (Vec::new(), Vec::new(), Vec::new());
    for text in [EXAMPLE, OTHER] {
        let sound = meaning(text).unwrap();
        for mutant in mutants(text) {
            all += 1;
            let found = problems(&mutant);
            let told = || found.iter().map(|found| format!("{}: {}", found.code(), found.message)).collect::<Vec<_>>();
            if found.iter().filter(|found| found.severity == Severity::Error).count() > MOST_ERRORS {
                cascades.push(format!("{:?}\n{mutant}", told()));
            }
            for problem in &found {
                for proposal in problem.proposals() {
                    proposed += 1;
                    let edits: Vec<_> = proposal.edits.iter().collect();
                    let mended = apply(&mutant, &edits).unwrap();
                    if !is_better(&found, &problems(&mended), problem) {
                        useless.push(format!("{:?}\n{mutant}\n=>\n{mended}", told()));
                    }
                    // With other mistakes left, the file has no meaning yet.
                    if proposal.is_sure {
                        sure += 1;
                        if meaning(&mended).is_some_and(|meaning| meaning != sound) {
                            wrong.push(format!("{:?}\n{mutant}\n=>\n{mended}", told()));
                        }
                    }
                }
            }
        }
    }
    wrong.iter().for_each(|it| println!("WRONG {it}"));
    println!("{all} mutants, {proposed} proposals, {sure} sure; {} useless, {} wrong", useless.len(), wrong.len());
    assert!(cascades.is_empty(), "too many errors: {}\n{}", cascades.len(), cascades.join("\n"));
    assert!(useless.is_empty(), "proposals that do not help: {}\n{}", useless.len(), useless.join("\n\n"));
    assert!(wrong.is_empty(), "sure proposals that change the meaning: {}\n{}", wrong.len(), wrong.join("\n\n"));
    assert!(all > 1_000 && sure > 200, "{all} mutants, {sure} sure");
}
