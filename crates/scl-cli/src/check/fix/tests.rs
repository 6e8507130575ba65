//! Whole files: what is fixed, and that everything else stays as it was.

use super::edit::{apply, groups};
use super::{fix, unified_diff};
use expect_test::{Expect, expect};
use scl_loader::{Loaded, Request, load_bytes};
use scl_topology::advice::{Extent, Judged, try_advice};
use scl_topology::catalogue::ALL;
use scl_topology::diagnostic::{Edit, Severity};
use scl_topology::external::FILE_NOT_FOUND;
use scl_topology::source::Span;
use std::collections::HashSet;

fn fixed(text: &str) -> (String, usize, usize) {
    let check = |text: &str| load_bytes(&Request::new("topology.yaml"), text.as_bytes().to_vec());
    let fixed = fix(check(text), None, text.to_owned(), check);
    let errors = fixed.loaded.diagnostics.iter().filter(|found| found.severity == Severity::Error).count();
    (fixed.text, fixed.applied, errors)
}

/// Number of fixes, number of errors that are left, and the difference; the same with other line ends, a byte order
/// mark, and without the last line break.
#[track_caller]
fn check(text: &str, expected: Expect) {
    let (new, applied, errors) = fixed(text);
    expected.assert_eq(&format!("{applied} fixed, {errors} left\n{}", unified_diff("topology.yaml", text, &new)));
    let crlf = |text: &str| text.replace('\n', "\r\n");
    let marked = |text: &str| format!("\u{feff}{text}");
    let cut = |text: &str| text.trim_end_matches('\n').to_owned();
    for spelling in [&crlf as &dyn Fn(&str) -> String, &marked, &cut] {
        assert_eq!(fixed(&spelling(text)), (spelling(&new), applied, errors));
    }
}

#[test]
fn several_problems_at_once() {
    check(
        "\
components:
  - name: sensor
    gates:
      - measurements: publish
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor/measurements, sensor.controller]
",
        expect![[r#"
            3 fixed, 0 left
            --- topology.yaml
            +++ topology.yaml
            @@ -1,9 +1,9 @@
             components:
               - name: sensor
                 gates:
            -      - measurements: publish
            +      - measurements: pub
               - name: controller
                 gates:
                   - sensor: sub
             connections:
            -  - [sensor/measurements, sensor.controller]
            +  - [sensor.measurements, controller.sensor]
        "#]],
    );
}

#[test]
fn odd_separators_become_commas() {
    for separator in [" ", " -> ", " ; ", ": "] {
        let text = |separator| {
            "\
components:
  - name: a
    gates:
      - x: pub
  - name: b
    gates:
      - x: sub
connections:
  - [a.x, b.x]
"
            .replace(", ", separator)
        };
        assert_eq!(fixed(&text(separator)), (text(", "), 1, 0), "{separator}");
    }
}

#[test]
fn what_may_mean_several_things_is_left() {
    let text = "components:\n  - name: a\n    gates:\n      - x1: pub\n      - x2: pub\n  - name: b\n    gates:\n      - x: sub\n\
                connections:\n  - [a.x3, b.x]\n";
    assert_eq!(fixed(text).0, text);
}

#[test]
fn a_file_without_problems_stays() {
    let text = "components: []\n";
    assert_eq!(fixed(text).0, text);
}

/// A check that finds the words `bad`, `worse` and `unsure` in a text: `bad` and `worse` have certain fixes, of which
/// that of `worse` makes two problems of one.
fn check_words(text: &str) -> Loaded {
    let mut loaded = untried(text);
    let judged =
        |loaded: &mut Loaded| Judged { problems: std::mem::take(&mut loaded.diagnostics), extent: Extent::default() };
    let mut found = judged(&mut loaded);
    try_advice(&mut found, loaded.sources.file(loaded.file.unwrap()), |copy| judged(&mut untried(copy)));
    loaded.diagnostics = found.problems;
    loaded
}

fn untried(text: &str) -> Loaded {
    let mut loaded = Loaded::default();
    let file = loaded.sources.add("t.yaml", text);
    loaded.file = Some(file);
    for (word, replacement, is_certain) in
        [("bad", "good\n", true), ("worse", "unsure unsure", true), ("unsure", "sure", false)]
    {
        for (at, _) in text.match_indices(word) {
            let span = Span { file, start: at as u32, end: (at + word.len()) as u32 };
            let found = FILE_NOT_FOUND.at(word, span, "");
            let edits = [Edit::new(span, replacement)];
            let found = if is_certain { found.propose(word, edits) } else { found.suggest(word, edits) };
            loaded.diagnostics.push(found);
        }
    }
    loaded
}

fn fixed_words(text: &str) -> (String, usize) {
    let fixed = fix(check_words(text), None, text.to_owned(), check_words);
    (fixed.text, fixed.applied)
}

#[test]
fn only_sure_fixes_that_help_are_applied() {
    let cases = [
        ("unsure", "unsure", 0),
        ("bad", "good\n", 1),
        ("worse", "worse", 0),
        ("bad, worse, bad", "good\n, worse, good\n", 2),
        ("worse, bad, worse, unsure", "worse, good\n, worse, unsure", 1),
    ];
    for (text, new, applied) in cases {
        assert_eq!(fixed_words(text), (new.to_owned(), applied), "{text}");
    }
}

#[test]
fn line_breaks_are_those_of_the_file() {
    assert_eq!(fixed_words("a\r\nbad\r\n").0, "a\r\ngood\r\n\r\n");
    assert_eq!(fixed_words("a\nb\nbad\r\n").0, "a\nb\ngood\n\r\n");
}

#[test]
fn fixes_that_overlap_are_not_applied_at_once() {
    let mut loaded = check_words("abcdef");
    let file = loaded.file.unwrap();
    for (start, end, replacement) in [(0, 2, "1"), (1, 3, "2"), (2, 2, "3"), (3, 4, "4"), (5, 5, "5")] {
        let span = Span { file, start, end };
        let found = FILE_NOT_FOUND.at(replacement, span, "");
        loaded.diagnostics.push(found.propose("", [Edit::new(span, replacement)]));
    }
    let mut found = Judged { problems: std::mem::take(&mut loaded.diagnostics), extent: Extent::default() };
    let all_solved = |_: &str| Judged { problems: Vec::new(), extent: Extent::default() };
    try_advice(&mut found, loaded.sources.file(file), all_solved);
    loaded.diagnostics = found.problems;
    let groups = groups(&loaded, file, &HashSet::new());
    assert_eq!(apply("abcdef", &groups), "1c4e5f");
}

/// The rules whose examples are fixed, so that it shows when a rule stops offering its fix.
#[test]
fn a_sure_fix_of_an_example_removes_its_problem() {
    let mut fixed_rules = Vec::new();
    for rule in ALL.iter().filter(|rule| rule.has_topology()) {
        let bad = rule.bad_example();
        let check = |text: &str| load_bytes(&Request::new("topology.yaml"), text.as_bytes().to_vec());
        let loaded = check(&bad);
        let has_fix =
            loaded.diagnostics.iter().any(|found| found.rule == *rule && found.proposals().any(|way| way.is_sure));
        if has_fix {
            let fixed = fix(loaded, None, bad, check);
            let left = fixed.loaded.diagnostics.iter().find(|found| found.rule == *rule);
            assert!(left.is_none(), "{}: {left:?} in {}", rule.code, fixed.text);
            fixed_rules.push(rule.code);
        }
    }
    expect!["SCL0101 SCL0102 SCL0103 SCL0108 SCL0113 SCL0114 SCL0117 SCL0118 SCL0119 SCL0122 SCL0123 SCL0124 SCL0127 SCL0129 SCL0130 SCL0131 SCL0132 SCL0201 SCL0202 SCL0204 SCL0207 SCL0214 SCL0216 SCL0303 SCL0304 SCL0401 SCL0403 SCL0407 SCL0503 SCL0504 SCL0510 SCL0711 SCL1301 SCL1302 SCL1305 SCL1306 SCL1402 SCL1403 SCL1603 SCL1605 SCL1901"]
        .assert_eq(&fixed_rules.join(" "));
}

/// Sound files.
const SOUND: [&str; 8] = [
    "crates/scl-topology/tests/files/rover.yaml",
    "crates/scl-topology/tests/files/listing_1.yaml",
    "crates/scl-topology/tests/files/system.yaml",
    "examples/quickstart/topology.yaml",
    "tests/topologies/six_kinds.yaml",
    "tests/topologies/twins.yaml",
    "tests/topologies/limits.yaml",
    "tests/topologies/shapes/original.yaml",
];

/// Of the mutants, one in this number is tried, unless `SCL_ALL_MUTANTS` is set: all of them take minutes.
const STEP: usize = 4;

/// A sound file with one character deleted, replaced or doubled: a fix that is called sure restores what was there, or
/// leaves an error.
#[test]
fn a_sure_fix_restores_what_was_there() {
    let step = if std::env::var_os("SCL_ALL_MUTANTS").is_some() { 1 } else { STEP };
    let (mut offered, mut tried, mut restored, mut wrong) = (0_usize, 0, 0, Vec::new());
    for path in SOUND {
        let whole = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
        let sound = std::fs::read_to_string(whole).unwrap().replace("schemas:", "x-schemas:");
        let expected = meaning(&sound);
        assert_ne!(expected, "", "{path}");
        for (at, letter) in sound.char_indices() {
            // In place of a mark, a letter would be a second mistake.
            let other = if letter.is_alphanumeric() { ["", "q", "."][at % 3] } else { "" }.to_owned();
            for other in [other, format!("{letter}{letter}")] {
                offered += 1;
                if !offered.is_multiple_of(step) {
                    continue;
                }
                tried += 1;
                let mutant = format!("{}{other}{}", &sound[..at], &sound[at + letter.len_utf8()..]);
                let (new, applied, errors) = fixed(&mutant);
                if applied == 0 || errors > 0 {
                    continue;
                }
                match meaning(&new) == expected {
                    true => restored += 1,
                    false => wrong.push(format!(
                        "{}{}",
                        unified_diff(path, &sound, &mutant),
                        unified_diff("mutant", &mutant, &new)
                    )),
                }
            }
        }
    }
    println!("{tried} mutants of {} files: {restored} restored, {} with another meaning", SOUND.len(), wrong.len());
    assert!(wrong.is_empty(), "{} fixes give another meaning:\n{}", wrong.len(), wrong.join("\n"));
    assert!(tried > 2_000 && restored > 400, "{tried} tried, {restored} restored");
}

/// All that a topology says.
fn meaning(text: &str) -> String {
    let loaded = load_bytes(&Request::new("topology.yaml"), text.as_bytes().to_vec());
    let Some(topology) = loaded.topology else { return String::new() };
    let gates = topology.components().flat_map(|(_, component)| component.gates().to_vec());
    let kinds: Vec<_> = gates
        .map(|id| {
            let gate = topology.gate(id);
            let types: Vec<_> = gate.payload().types().into_iter().map(|name| name.dotted().to_owned()).collect();
            (topology.gate_path(id), gate.kind(), types, gate.doc().map(str::to_owned), gate.options().clone())
        })
        .collect();
    let sizes: Vec<_> = topology.components().map(|(_, component)| component.gates().len()).collect();
    let pairs: Vec<_> = topology.connections().map(|(_, pair)| (pair.source(), pair.sink())).collect();
    format!("{kinds:?} {sizes:?} {pairs:?}")
}
