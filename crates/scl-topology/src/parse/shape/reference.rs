//! References to a type as other formats have them: `#/components/schemas/Weighing`, `./scale.proto#Weighing`.

use crate::source::SourceFile;

/// Maximum number of names that are offered.
const MOST: usize = 3;

/// Whether a text is a dotted name.
pub(super) fn is_type(text: &str) -> bool {
    text.split('.')
        .all(|part| part.starts_with(|letter: char| letter.is_ascii_alphabetic()) && part.chars().all(is_part))
}

fn is_part(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

/// The types that a text may mean: itself, or for a reference the dotted names of the `source` that end with its last
/// word, or else this word.
pub(super) fn types_meant(text: &str, source: Option<&SourceFile>) -> Vec<String> {
    if is_type(text) {
        return vec![text.to_owned()];
    }
    let last = text.rsplit(|letter| !is_part(letter)).find(|word| !word.is_empty());
    let Some(last) = last.filter(|last| text.contains(['/', '#']) && is_type(last)) else { return Vec::new() };
    let mut names: Vec<String> = Vec::new();
    let text = source.map_or("", SourceFile::text);
    for word in text.split(|letter: char| !is_part(letter) && letter != '.') {
        let is_it = word.strip_suffix(last).is_some_and(|package| package.ends_with('.'));
        if is_it && names.len() < MOST && is_type(word) && !names.iter().any(|name| name == word) {
            names.push(word.to_owned());
        }
    }
    if names.is_empty() {
        names.push(last.to_owned());
    }
    names
}
