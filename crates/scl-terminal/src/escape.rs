//! Untrusted text on the terminal: characters that would move the cursor, change colours or reorder text are escaped.

use std::borrow::Cow;
use std::fmt::Write;

/// Shows control characters and characters that change the direction of text as escapes: `\n`, `\t`, `\u{1b}`.
/// Everything else stays as it is, so a backslash may also come from the text itself.
pub fn escape(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unsafe) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match is_unsafe(c) {
            true => shown.extend(c.escape_default()),
            false => shown.push(c),
        }
    }
    Cow::Owned(shown)
}

/// [`escape`] for bytes that may not be UTF-8: invalid bytes are shown as `\xff`.
pub fn escape_bytes(bytes: &[u8]) -> String {
    let mut shown = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        shown.push_str(&escape(chunk.valid()));
        for byte in chunk.invalid() {
            // Writing to a string cannot fail.
            let _ = write!(shown, "\\x{byte:02x}");
        }
    }
    shown
}

/// Escapes characters of JSON text that `serde_json` leaves as they are but a terminal would interpret. They become
/// escapes of JSON, so the value stays the same.
pub fn escape_json(json: &str) -> Cow<'_, str> {
    // Line breaks between values are not part of a string; inside strings, they are already escaped.
    let is_unsafe = |c: char| c != '\n' && is_unsafe(c);
    if !json.contains(is_unsafe) {
        return Cow::Borrowed(json);
    }
    let mut shown = String::with_capacity(json.len() + 16);
    for c in json.chars() {
        match is_unsafe(c) {
            // All unsafe characters are in Unicode's Basic Multilingual Plane.
            true => shown.push_str(&format!("\\u{:04x}", u32::from(c))),
            false => shown.push(c),
        }
    }
    Cow::Owned(shown)
}

/// Whether this is a control character, or one that changes the direction of text (UAX 9) or breaks lines. Such
/// characters can make a text look like a different one (CVE-2021-42574).
fn is_unsafe(c: char) -> bool {
    let changes_direction = matches!(
        c,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    c.is_control() || changes_direction || matches!(c, '\u{2028}' | '\u{2029}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_terminal_would_obey_is_escaped() {
        for (text, expected) in [
            ("plain, ümläut, 速度 and \\ stay", "plain, ümläut, 速度 and \\ stay"),
            ("two\nlines\r\tand a tab", "two\\nlines\\r\\tand a tab"),
            ("\u{1b}[31mred\u{7}\0", "\\u{1b}[31mred\\u{7}\\u{0}"),
            ("\u{7f}\u{9b}31m", "\\u{7f}\\u{9b}31m"),
            ("user\u{202e}gpj.exe\u{2066}", "user\\u{202e}gpj.exe\\u{2066}"),
            ("\u{61c}\u{200f}\u{2028}", "\\u{61c}\\u{200f}\\u{2028}"),
        ] {
            assert_eq!(escape(text), expected);
        }
    }

    #[test]
    fn json_keeps_its_value() {
        let text = "a \u{7f} \u{9b} \u{202e} \n \u{1b} é";
        let json = format!("{{\n  \"text\": {}\n}}\n", serde_json::to_string(text).unwrap());
        let escaped = escape_json(&json);
        assert_eq!(escaped, "{\n  \"text\": \"a \\u007f \\u009b \\u202e \\n \\u001b é\"\n}\n");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&escaped).unwrap()["text"], text);
    }

    #[test]
    fn bytes_that_are_not_text_are_shown() {
        assert_eq!(escape_bytes(b"speed \xff\xfe 1\x1b"), "speed \\xff\\xfe 1\\u{1b}");
        assert_eq!(escape_bytes("速度".as_bytes()), "速度");
    }
}
