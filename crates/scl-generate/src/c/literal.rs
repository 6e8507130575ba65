//! Texts as string literals of C.

/// The literal of a text. Question marks are escaped, because they could begin a trigraph.
pub(super) fn literal(text: &str) -> String {
    let mut literal = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' | '?' => literal.extend(['\\', letter]),
            ' '..='~' => literal.push(letter),
            other => other.to_string().bytes().for_each(|byte| literal.push_str(&format!("\\{byte:03o}"))),
        }
    }
    literal + "\""
}
