//! Sound files with one word or mark deleted, doubled or misspelt: whatever comes of them is Rust.

use super::{errors, expand, parsed, structs};
use std::ops::Range;

const FILES: [&str; 3] = [
    include_str!("../../../scl-topology/tests/files/listing_1.yaml"),
    include_str!("../../../scl-topology/tests/files/rover.yaml"),
    include_str!("../../../scl-topology/tests/files/system.yaml"),
];

/// Each takes some milliseconds. With a prime number every kind of mutation comes up; 1 tries all.
const STEP: usize = 11;

#[test]
fn every_mutation_expands_to_rust() {
    let (mut accepted, mut refused) = (0, 0);
    for text in FILES.map(without_schemas) {
        assert_eq!(errors(&expand(&text)), 0, "a sound file:\n{text}");
        let all = tokens(&text).into_iter().flat_map(|token| mutants(&text, &token));
        for mutant in all.step_by(STEP) {
            let is_accepted = judge(&mutant);
            *(if is_accepted { &mut accepted } else { &mut refused }) += 1;
        }
    }
    println!("{accepted} mutants are topologies, {refused} are refused");
    assert!(accepted > 20 && refused > 150, "{accepted} accepted, {refused} refused");
}

/// Types are then taken from Rust, so that the test is the same without the feature `protobuf`.
fn without_schemas(text: &str) -> String {
    text.split_inclusive('\n').filter(|line| !line.starts_with("schemas:")).collect()
}

/// Whether the checker accepts a file. Its expansion is a Rust file, and either it has errors or all of its components
/// can be opened.
fn judge(mutant: &str) -> bool {
    let tokens = expand(mutant);
    let file = parsed(&tokens);
    let text = tokens.to_string();
    let is_accepted = !text.contains("compile_error");
    assert!(!is_accepted || !text.contains("unreachable ! ()"), "a skeleton without an error:\n{mutant}");
    assert!(!is_accepted || !structs(&file).is_empty(), "nothing, without an error:\n{mutant}");
    is_accepted
}

/// Words and single marks.
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
        // A keyword of Rust wherever a name may stand.
        mutants.push(with("type"));
    }
    mutants
}
