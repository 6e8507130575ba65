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
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}
