//! Lists as texts: `[1, 2, 3]`, or `["a, b", c]` where an item needs quotes.

/// What ends an item, or would.
const SPECIAL: [char; 5] = [',', '"', '[', ']', '\\'];

/// A list of these items, as the value of a parameter.
pub fn list_text<S: AsRef<str>>(items: impl IntoIterator<Item = S>) -> String {
    let items: Vec<String> = items.into_iter().map(|item| quoted(item.as_ref())).collect();
    format!("[{}]", items.join(", "))
}

/// The items of a list, with or without its brackets.
///
/// # Errors
/// A quote or a bracket is open, or an item is empty.
pub(super) fn items(text: &str) -> Result<Vec<String>, String> {
    let text = text.trim();
    let inner = match (text.strip_prefix('['), text.strip_suffix(']')) {
        (Some(_), Some(_)) => &text[1..text.len() - 1],
        (None, None) => text,
        _ => return Err("one of the brackets `[` and `]` is missing".to_owned()),
    };
    split(inner)?.into_iter().map(unquoted).collect()
}

/// The parts between commas, but not between commas in quotes or brackets; none if there is no text.
pub(super) fn split(text: &str) -> Result<Vec<&str>, String> {
    if text.trim().is_empty() {
        return Ok(Vec::new());
    }
    let (mut parts, mut start, mut depth, mut in_quotes, mut is_escaped) = (Vec::new(), 0, 0_u32, false, false);
    for (at, letter) in text.char_indices() {
        match letter {
            _ if is_escaped => is_escaped = false,
            '\\' if in_quotes => is_escaped = true,
            '"' => in_quotes = !in_quotes,
            _ if in_quotes => {}
            '[' => depth += 1,
            ']' => depth = depth.checked_sub(1).ok_or("a bracket `]` has no `[` before it")?,
            ',' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    if in_quotes {
        return Err("a quote `\"` is not closed".to_owned());
    }
    if depth > 0 {
        return Err("a bracket `[` is not closed".to_owned());
    }
    parts.push(&text[start..]);
    Ok(parts)
}

/// A text as an item: in quotes where it would not be read as it is.
pub(super) fn quoted(text: &str) -> String {
    let is_plain = !text.is_empty() && text.trim() == text && !text.contains(SPECIAL);
    if is_plain { text.to_owned() } else { format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"")) }
}

/// An item without its quotes, if it has any.
pub(super) fn unquoted(item: &str) -> Result<String, String> {
    let item = item.trim();
    let Some(rest) = item.strip_prefix('"') else {
        return if item.is_empty() { Err("an item is empty".to_owned()) } else { Ok(item.to_owned()) };
    };
    let (mut text, mut letters) = (String::new(), rest.chars());
    while let Some(letter) = letters.next() {
        match letter {
            '"' if letters.as_str().is_empty() => return Ok(text),
            '"' => break,
            '\\' => text.extend(letters.next()),
            letter => text.push(letter),
        }
    }
    Err(format!("`{item}` goes on behind its quotes"))
}
