//! Sound files with one character, token, word or line deleted, doubled, swapped or misspelt. Each mutant is told on
//! the line of the mutation, or the checker proves that it is still a topology; no mutant makes a panic, and none makes
//! more than three errors.

use scl_topology::advice::{Extent, Judged, apply, try_advice};
use scl_topology::check::{Facts, SchemaMessages, check};
use scl_topology::diagnostic::{Diagnostic, Diagnostics, Severity};
use scl_topology::parse::parse;
use scl_topology::source::{FileId, Sources};
use std::ops::Range;

const FILES: [(&str, &str); 4] = [
    ("listing_1", include_str!("files/listing_1.yaml")),
    ("rover", include_str!("files/rover.yaml")),
    ("system", include_str!("files/system.yaml")),
    ("kinds", include_str!("files/kinds.yaml")),
];

/// Files that were written for other purposes, with their own comments, styles and options.
const OTHER_FILES: [(&str, &str); 9] = [
    ("shapes", include_str!("../../../tests/topologies/shapes/original.yaml")),
    ("flow", include_str!("files/flow.json")),
    ("quickstart", include_str!("../../../examples/quickstart/topology.yaml")),
    ("six_kinds", include_str!("../../../tests/topologies/six_kinds.yaml")),
    ("twins", include_str!("../../../tests/topologies/twins.yaml")),
    ("limits", include_str!("../../../tests/topologies/limits.yaml")),
    ("exits", include_str!("../../../tests/topologies/exits.yaml")),
    ("ten_gates", include_str!("../../../tests/topologies/ten_gates.yaml")),
    ("fanout", include_str!("../../../bench/fanout.yaml")),
];

/// What the schema of the rover declares.
const MESSAGES: [&str; 5] = ["rover.Measurement", "rover.Setpoint", "rover.Event", "rover.Command", "rover.Status"];

/// Of the mutants of the other files, one in this number is tried, unless `SCL_ALL_MUTANTS` is set: all of them take
/// minutes without optimization.
const STEP: usize = 4;

/// No mistake makes more errors.
const MOST_ERRORS: usize = 3;

/// Whether a topology comes out; errors and warnings with the lines of their places, the own first.
fn problems(text: &str) -> (bool, Vec<(Diagnostic, Vec<u32>)>) {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let (is_valid, mut found) = judge(&sources, file);
    try_advice(&mut found, sources.file(file), |copy| judge(&sources.with_text(file, copy), file).1);
    let found = found.problems.into_iter().filter(|found| found.severity != Severity::Lint);
    let lines = |found: &Diagnostic| {
        let labels = found.primary.iter().chain(&found.secondary);
        labels.map(|at| sources.file(at.span.file).line_column(at.span.start).line).collect()
    };
    (is_valid, found.map(|found| (found.clone(), lines(&found))).collect())
}

fn judge(sources: &Sources, file: FileId) -> (bool, Judged) {
    let mut problems = Diagnostics::new();
    let model = parse(sources, file, &mut problems);
    let messages = SchemaMessages { names: MESSAGES.map(str::to_owned).to_vec(), ..SchemaMessages::default() };
    // Types of schemas that are not read here are not looked up.
    let messages = model.schemas.iter().any(|schema| schema.value.contains("rover")).then(|| vec![messages]);
    let facts = Facts { default_system: "t".to_owned(), messages, ..Facts::default() };
    let topology = check(&model, &facts, sources, &mut problems);
    (topology.is_some(), Judged { problems: problems.into_sorted(), extent: Extent::of(&model) })
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

/// What is done to the characters of a line, to the line itself, and to it and the next.
fn mutants_of_line(text: &str, line: &Range<usize>) -> Vec<(&'static str, String)> {
    let content = text[line.clone()].trim_end_matches('\n');
    let with = |other: &str| format!("{}{other}{}", &text[..line.start], &text[line.end..]);
    let mut mutants = vec![("line deleted", with("")), ("line doubled", with(&format!("{content}\n{content}\n")))];
    if let Some(next) = text[line.end..].split_inclusive('\n').next() {
        let swapped = format!("{}{next}{content}\n{}", &text[..line.start], &text[line.end + next.len()..]);
        mutants.push(("lines swapped", swapped));
    }
    let code = content.split(" #").next().unwrap_or(content);
    for (at, letter) in code.char_indices().filter(|(_, letter)| letter.is_ascii()) {
        let (before, after) = (&content[..at], &content[at + 1..]);
        mutants.push(("character deleted", with(&format!("{before}{after}\n"))));
        if !letter.is_alphanumeric() {
            mutants.push(("character doubled", with(&format!("{before}{letter}{letter}{after}\n"))));
        }
        if let Some(next) = after.chars().next().filter(|next| next.is_ascii() && *next != letter) {
            mutants.push(("characters swapped", with(&format!("{before}{next}{letter}{}\n", &after[1..]))));
        }
    }
    mutants
}

#[derive(Default)]
struct Tally {
    all: usize,
    /// What is reported about the sound file already.
    known: Vec<String>,
    /// How many mutants were offered, tried or not.
    offered: usize,
    /// Another topology, as good as the first.
    valid: usize,
    /// The place of a problem is on the line.
    on_line: usize,
    /// A problem elsewhere shows the line, as it does where a declaration is misspelt and its use is not.
    shown: usize,
    /// Mutants that are no YAML.
    syntax_errors: usize,
    /// Those of them that no rule explains.
    unexplained: Vec<String>,
    /// Proposals, those of them that are sure, and those of these that give the sound file again.
    proposed: usize,
    sure: usize,
    sure_as_before: usize,
    /// Proposals that leave their problem, or add an error.
    useless: Vec<String>,
    /// The largest number of errors.
    most_errors: usize,
    elsewhere: Vec<String>,
    cascades: Vec<String>,
}

impl Tally {
    fn judge(&mut self, name: &str, what: &str, text: &str, place: &Range<usize>, mutant: &str) {
        let line = text[..place.start].matches('\n').count() as u32 + 1;
        let (is_valid, mut found) = problems(mutant);
        found.retain(|(found, _)| !self.known.contains(&found.message));
        let told = || found.iter().map(|(found, at)| format!("{} {at:?}", found.code())).collect::<Vec<_>>().join(", ");
        let word = text[place.clone()].trim_end();
        let entry = || format!("{name}:{line} `{word}` {what}: {}", told());
        // Two lines that changed places are both at fault, and a line that is gone is nowhere.
        let lines = match what {
            "line deleted" => 1..=u32::MAX,
            "line doubled" | "lines swapped" => line..=line + 1,
            _ => line..=line,
        };
        self.all += 1;
        if found.iter().any(|(_, at)| at.first().is_some_and(|at| lines.contains(at))) {
            self.on_line += 1;
        } else if found.iter().any(|(_, at)| at.iter().any(|at| lines.contains(at))) {
            self.shown += 1;
        } else if is_valid && found.is_empty() {
            self.valid += 1;
        } else {
            self.elsewhere.push(entry());
        }
        let errors = found.iter().filter(|(found, _)| found.severity == Severity::Error).count();
        self.most_errors = self.most_errors.max(errors);
        if errors > MOST_ERRORS {
            self.cascades.push(entry());
        }
        for (problem, _) in &found {
            for proposal in problem.proposals() {
                self.proposed += 1;
                let edits: Vec<_> = proposal.edits.iter().collect();
                let mended = apply(mutant, &edits).expect("the changes of a proposal do not overlap");
                let left = problems(&mended).1;
                if !is_better(&found, &left, problem) {
                    let words = render_helps(problem);
                    let left: Vec<String> = left.iter().map(|(left, at)| format!("{} {at:?}", left.message)).collect();
                    self.useless.push(format!("{}: {words}; left: {left:?}\n{mutant}\n=>\n{mended}", entry()));
                }
                self.sure += usize::from(proposal.is_sure);
                self.sure_as_before += usize::from(proposal.is_sure && mended == text);
            }
        }
        self.syntax_errors += usize::from(found.iter().any(|(found, _)| is_syntax_error(found.code())));
        if found.iter().any(|(found, _)| found.code() == "SCL0121") {
            self.unexplained.push(entry());
        }
    }

    /// The share of the mutants that are no topologies, in percent.
    fn share(&self, part: usize) -> f64 {
        100.0 * part as f64 / (self.all - self.valid) as f64
    }

    fn print(&self) {
        println!(
            "{} mutants: {} are topologies; of the others {:.1} % are told on their line, {:.1} % show it, {:.1} % ({}) are \
             told elsewhere; at most {} errors; {} syntax errors, {} of them unexplained; {} proposals, {} of them \
             useless; {} are sure, {} of them give the sound file",
            self.all,
            self.valid,
            self.share(self.on_line),
            self.share(self.shown),
            self.share(self.elsewhere.len()),
            self.elsewhere.len(),
            self.most_errors,
            self.syntax_errors,
            self.unexplained.len(),
            self.proposed,
            self.useless.len(),
            self.sure,
            self.sure_as_before,
        );
    }
}

/// Whether a change solved a problem without adding an error: this does without the places and the allowances of the
/// trial itself, because a sound file with one mistake needs neither.
fn is_better(before: &[(Diagnostic, Vec<u32>)], after: &[(Diagnostic, Vec<u32>)], problem: &Diagnostic) -> bool {
    let count = |of: &[(Diagnostic, Vec<u32>)], wanted: &Diagnostic| {
        of.iter().filter(|(found, _)| found.rule == wanted.rule && found.message == wanted.message).count()
    };
    let errors = after.iter().filter(|(found, _)| found.severity == Severity::Error);
    count(after, problem) < count(before, problem)
        && errors.map(|(found, _)| found).all(|found| count(after, found) <= count(before, found))
}

fn render_helps(problem: &Diagnostic) -> String {
    problem.shown_helps().map(|help| help.text().into_owned()).collect::<Vec<_>>().join(" | ")
}

/// Whether a rule is about text that is not valid YAML.
fn is_syntax_error(code: &str) -> bool {
    matches!(code, "SCL0102" | "SCL0103" | "SCL0104" | "SCL0105" | "SCL0106") || ("SCL0121".."SCL0126").contains(&code)
}

#[test]
fn every_mutation_is_told_on_its_line_or_is_a_topology() {
    let mut tally = Tally::default();
    for (name, text) in FILES {
        assert_eq!(problems(text).1, [], "{name} is sound");
        for token in tokens(text) {
            for (what, mutant) in mutants(text, &token) {
                tally.judge(name, what, text, &token, &mutant);
            }
        }
    }
    tally.print();
    assert!(tally.elsewhere.is_empty(), "told elsewhere:\n{}", tally.elsewhere.join("\n"));
    assert!(tally.cascades.is_empty(), "too many errors:\n{}", tally.cascades.join("\n"));
    assert!(tally.useless.is_empty(), "proposals that do not help:\n{}", tally.useless.join("\n\n"));
    let on_line = tally.share(tally.on_line);
    assert!(tally.all > 2_500 && on_line > 85.0, "{} mutants, {on_line:.1} %", tally.all);
}

#[test]
fn mutations_of_files_that_were_not_written_for_it() {
    let mut tally = Tally::default();
    let step = if std::env::var_os("SCL_ALL_MUTANTS").is_some() { 1 } else { STEP };
    let try_some = |tally: &mut Tally, name: &str, what: &str, text: &str, place: &Range<usize>, mutant: &str| {
        tally.offered += 1;
        if tally.offered.is_multiple_of(step) {
            tally.judge(name, what, text, place, mutant);
        }
    };
    for (name, text) in OTHER_FILES {
        let (is_valid, known) = problems(text);
        assert!(is_valid, "{name} is a topology");
        tally.known = known.into_iter().map(|(found, _)| found.message).collect();
        for token in tokens(text) {
            for (what, mutant) in mutants(text, &token) {
                try_some(&mut tally, name, what, text, &token, &mutant);
            }
        }
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let range = start..start + line.len();
            for (what, mutant) in mutants_of_line(text, &range) {
                try_some(&mut tally, name, what, text, &range, &mutant);
            }
            start = range.end;
        }
    }
    tally.print();
    assert!(tally.cascades.is_empty(), "too many errors:\n{}", tally.cascades.join("\n"));
    assert!(tally.useless.is_empty(), "proposals that do not help:\n{}", tally.useless.join("\n\n"));
    let told = tally.share(tally.on_line + tally.shown);
    assert!(told > 99.0, "{told:.1} % show the line; elsewhere:\n{}", tally.elsewhere.join("\n"));
    let unexplained = 100.0 * tally.unexplained.len() as f64 / tally.syntax_errors as f64;
    assert!(unexplained < 0.5, "{unexplained:.1} % unexplained:\n{}", tally.unexplained.join("\n"));
}
