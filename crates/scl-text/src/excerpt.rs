//! Long texts in error messages.

/// Maximum number of characters of a wrong value that an error quotes.
const MOST: usize = 40;

/// Returns the text, or its start if a line cannot hold it.
///
/// ```
/// use scl_text::excerpt::excerpt;
/// assert_eq!(excerpt("ab"), "ab");
/// assert_eq!(excerpt(&"ä".repeat(41)), format!("{}...", "ä".repeat(40)));
/// ```
pub fn excerpt(text: &str) -> String {
    start_of(text, MOST)
}

/// [`excerpt`] with another number of characters.
pub fn start_of(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}
