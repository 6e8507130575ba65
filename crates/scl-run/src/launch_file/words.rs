//! Words: compared without case and marks, and written into brackets.

pub(super) use scl_text::suggest::bare;

/// Whether a word is another one without case and marks, which [`bare`] has removed from `bare_word`.
pub(super) fn is_bare(word: &str, bare_word: &str) -> bool {
    let letters = word.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase);
    letters.eq(bare_word.chars())
}

/// A word as it may stand in a list or a mapping in brackets: in quotes where it needs them.
pub(super) fn flow_word(text: &str) -> String {
    let is_odd_start = text.starts_with(|letter: char| "-?!&*|>%@`\"'#,[]{}:= ".contains(letter))
        && !(text.starts_with('-') && text.len() > 1 && !text.starts_with("- "));
    let needs_quotes = text.is_empty()
        || is_odd_start
        || text.ends_with([' ', ':'])
        || text.contains(|letter: char| ",[]{}".contains(letter) || letter.is_control())
        || text.contains(": ")
        || text.contains(" #")
        || matches!(text, "~" | "null" | "Null" | "NULL");
    match needs_quotes {
        false => text.to_owned(),
        true if text.contains(char::is_control) => format!("{text:?}"),
        true if !text.contains(['"', '\\']) => format!("\"{text}\""),
        true => format!("'{}'", text.replace('\'', "''")),
    }
}

/// A list in brackets.
pub(super) fn flow_list<S: AsRef<str>>(words: &[S]) -> String {
    format!("[{}]", words.iter().map(|word| flow_word(word.as_ref())).collect::<Vec<_>>().join(", "))
}
