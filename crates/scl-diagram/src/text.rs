//! How wide a text is when it is drawn. No font is known here, so this is an estimate for common sans-serif fonts,
//! rather too wide than too narrow.

use unicode_width::UnicodeWidthChar;

/// The estimated width of a text in parts of its font size.
pub(crate) fn width(text: &str) -> f64 {
    text.chars().map(character_width).sum()
}

fn character_width(character: char) -> f64 {
    match character {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' => 0.30,
        'f' | 'r' | 't' | 'I' | '(' | ')' | '[' | ']' | '/' | ' ' | '-' => 0.40,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.95,
        'A'..='Z' => 0.72,
        '→' => 1.0,
        other if other.is_ascii() => 0.62,
        other => 0.65 * other.width().unwrap_or(0) as f64,
    }
}
