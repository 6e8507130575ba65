//! Valid files with one token deleted, doubled or misspelt: the expansion is always valid Rust.

use super::{errors, expand, parsed, structs};
use std::ops::Range;

const FILES: [&str; 3] = [
    include_str!("../../../crates/scl-topology/tests/files/listing_1.yaml"),
    include_str!("../../../crates/scl-topology/tests/files/rover.yaml"),
    include_str!("../../../crates/scl-topology/tests/files/system.yaml"),
];

/// Every how many mutants one is tested, because each takes some milliseconds. A prime number reaches every kind of
/// mutation; 1 tests all.
const STEP: usize = 11;

#[test]
fn every_mutation_expands_to_rust() {
    let (mut accepted, mut refused) = (0, 0);
    for text in FILES.map(without_schemas) {
        assert_eq!(errors(&expand(&text)), 0, "a valid file:\n{text}");
        let all = tokens(&text).into_iter().flat_map(|token| mutants(&text, &token));
        for mutant in all.step_by(STEP) {
            let is_accepted = is_accepted(&mutant);
            *(if is_accepted { &mut accepted } else { &mut refused }) += 1;
        }
    }
    println!("{accepted} mutants are topologies, {refused} are refused");
    assert!(accepted > 20 && refused > 150, "{accepted} accepted, {refused} refused");
}

/// Without schemas, the types come from Rust code, so the test needs no feature.
fn without_schemas(text: &str) -> String {
    text.split_inclusive('\n').filter(|line| !line.starts_with("schemas:")).collect()
}

/// Returns true if the checker accepts a file. The expansion must parse as Rust, and must either contain an error or
/// open every component.
fn is_accepted(mutant: &str) -> bool {
    let tokens = expand(mutant);
    let file = parsed(&tokens);
    let text = tokens.to_string();
    let is_accepted = !text.contains("compile_error");
    assert!(!is_accepted || !text.contains("unreachable ! ()"), "a skeleton without an error:\n{mutant}");
    assert!(!is_accepted || !structs(&file).is_empty(), "no struct and no error:\n{mutant}");
    is_accepted
}

/// The ranges of words and of single other characters.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut tokens: Vec<Range<usize>> = Vec::new();
    for (at, letter) in text.char_indices().filter(|(_, letter)| !letter.is_whitespace()) {
        let end = at + letter.len_utf8();
        match tokens.last_mut() {
            Some(last) if last.end == at && is_word(letter) && text[last.clone()].chars().all(is_word) => {
                last.end = end
            }
            _ => tokens.push(at..end),
        }
    }
    tokens
}

fn mutants(text: &str, token: &Range<usize>) -> Vec<String> {
    let word = &text[token.clone()];
    let with = |other: &str| format!("{}{other}{}", &text[..token.start], &text[token.end..]);
    let mut mutants = vec![with(""), with(&format!("{word}{word}"))];
    if word.len() > 1 {
        mutants.push(with(&word[..word.len() - 1]));
        // A Rust keyword in place of a name.
        mutants.push(with("type"));
    }
    mutants
}
