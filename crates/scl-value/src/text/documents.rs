//! A stream of messages as text: YAML documents, or one JSON value a line.

use super::yaml::{BYTE_ORDER_MARK, ReadError, read_yaml};
use crate::value::Value;

/// Splits lines into messages: a line that is a whole list or map, as in JSON lines, and everything between lines of
/// `---`.
///
/// ```
/// let mut documents = scl_value::Documents::default();
/// let lines = ["{speed: 1}", "speed: 2", "---", "speed: 3"];
/// let mut messages: Vec<_> = lines.iter().filter_map(|line| documents.line(line)).collect();
/// messages.extend(documents.end());
/// assert_eq!(messages.len(), 3);
/// ```
#[derive(Debug, Default)]
pub struct Documents {
    /// The lines of a message that is not complete.
    pending: String,
}

impl Documents {
    /// Adds a line, without its line ending. Returns the message that it completes.
    pub fn line(&mut self, line: &str) -> Option<Result<Value, ReadError>> {
        // If several files were concatenated, each may begin with a byte order mark.
        let line = line.trim_start_matches(BYTE_ORDER_MARK);
        if let Some(start) = line.strip_prefix("---").filter(|rest| rest.is_empty() || rest.starts_with([' ', '\t'])) {
            let complete = self.end();
            self.add(start.trim_start());
            return complete;
        }
        if line.trim_end() == "..." {
            return self.end();
        }
        if is_blank(&self.pending)
            && line.trim_start().starts_with(['{', '['])
            && let Ok(value) = read_yaml(line)
        {
            self.pending.clear();
            return Some(Ok(value));
        }
        self.add(line);
        None
    }

    /// Ends the text. Returns the message that this completes, if there is one.
    pub fn end(&mut self) -> Option<Result<Value, ReadError>> {
        let text = std::mem::take(&mut self.pending);
        (!is_blank(&text)).then(|| read_yaml(&text))
    }

    fn add(&mut self, line: &str) {
        self.pending.push_str(line);
        self.pending.push('\n');
    }
}

/// Whether a text has only comments and white space.
fn is_blank(text: &str) -> bool {
    text.lines().map(str::trim_start).all(|line| line.is_empty() || line.starts_with('#'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::to_json;

    #[test]
    fn messages_end_with_their_line_or_document() {
        let cases = [
            ("{a: 1}\n{\"a\": 2}\n", "{\"a\":1} {\"a\":2}"),
            ("a: 1\nb: 2\n---\na: 3", "{\"a\":1,\"b\":2} {\"a\":3}"),
            ("--- # sensor.measurements 1\na: 1\n--- {a: 2}\n", "{\"a\":1} {\"a\":2}"),
            ("---\na: 1\n...\n# comment\n---\na: 2\n---\n", "{\"a\":1} {\"a\":2}"),
            ("{a: 1,\n b: 2}\n---\n[3]\n4", "{\"a\":1,\"b\":2} [3] 4"),
            ("\n# nothing\n---\n\n", ""),
            ("\u{feff}{a: 1}\n{a: 2}\n\u{feff}{a: 3}\n", "{\"a\":1} {\"a\":2} {\"a\":3}"),
            ("\u{feff}---\r\na: 1\r\n\u{feff}---\r\na: 2\r\n", "{\"a\":1} {\"a\":2}"),
            ("\u{feff}a: 1\nb: 2\n", "{\"a\":1,\"b\":2}"),
            ("\u{feff}# nothing\n\u{feff}", ""),
            ("{a: 1\n---\na: 2", "error {\"a\":2}"),
        ];
        for (text, expected) in cases {
            let mut documents = Documents::default();
            let mut messages: Vec<_> = text.lines().filter_map(|line| documents.line(line)).collect();
            messages.extend(documents.end());
            let shown = messages.iter().map(|it| it.as_ref().map_or_else(|_| "error".to_owned(), to_json));
            assert_eq!(shown.collect::<Vec<_>>().join(" "), expected, "{text}");
        }
    }
}
