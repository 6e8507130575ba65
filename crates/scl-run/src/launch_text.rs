//! Positions in a launch file. The YAML library reports none for values, so keys are looked up in the text.

use scl_terminal::Problem;
use serde_yaml::Error;

/// The text of a launch file, and the path by which messages name it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaunchText<'a> {
    path: &'a str,
    text: &'a str,
}

impl<'a> LaunchText<'a> {
    /// Takes a text, without its byte order mark.
    pub(crate) fn new(path: &'a str, text: &'a str) -> Self {
        Self { path, text: text.strip_prefix('\u{feff}').unwrap_or(text) }
    }

    /// The text.
    pub(crate) fn text(&self) -> &'a str {
        self.text
    }

    /// The library's error for invalid YAML, with the position moved in front of the message.
    pub(crate) fn syntax_problem(&self, error: &Error) -> Problem {
        let words = error.to_string();
        let Some(location) = error.location() else { return Problem::new(words).at(self.path) };
        let (line, column) = (location.line(), location.column());
        let headline = words.replace(&format!(" at line {line} column {column}"), "");
        Problem::new(headline).at(format!("{}:{line}:{column}", self.path))
    }

    /// Position of the last of these keys, as `launch.yaml:3:5`. Each is searched for after the one before it. If one
    /// is not found (for example because it is written with escapes), the position of the key before it.
    pub(crate) fn place(&self, keys: &[&str]) -> String {
        let mut at = keys.first().and_then(|key| self.find_top_key(key));
        for key in keys.iter().skip(1) {
            let Some(found) = at.and_then(|at| self.find_key(key, at + 1)) else { break };
            at = Some(found);
        }
        let Some(at) = at else { return self.path.to_owned() };
        let before = &self.text[..at];
        let line_start = before.rfind('\n').map_or(0, |end| end + 1);
        let line = before.matches('\n').count() + 1;
        let column = before[line_start..].chars().count() + 1;
        format!("{}:{line}:{column}", self.path)
    }

    /// A key at the start of a line, else (as in a file that is one `{...}`) the first one.
    fn find_top_key(&self, key: &str) -> Option<usize> {
        let starts = self.text.match_indices(key).map(|(at, _)| at);
        let is_at_start =
            |at: usize| matches!(self.text[..at].trim_end_matches(['"', '\'']).chars().next_back(), None | Some('\n'));
        let mut in_block = starts.into_iter().filter(|&at| is_at_start(at) && self.is_key(at, key.len()));
        in_block.next().or_else(|| self.find_key(key, 0))
    }

    /// The first position from `start` on where `key` is used as a key, outside comments.
    fn find_key(&self, key: &str, start: usize) -> Option<usize> {
        let from = self.text.get(start..)?;
        let candidates = from.match_indices(key).map(|(at, _)| start + at);
        candidates.into_iter().find(|&at| self.is_key(at, key.len()) && !self.is_in_comment(at))
    }

    fn is_key(&self, at: usize, length: usize) -> bool {
        let before = self.text[..at].chars().next_back();
        let after = self.text[at + length..].trim_start_matches(['"', '\'']).trim_start_matches(' ');
        before.is_none_or(|c| c.is_whitespace() || "{,\"'".contains(c)) && after.starts_with(':')
    }

    fn is_in_comment(&self, at: usize) -> bool {
        let line_start = self.text[..at].rfind('\n').map_or(0, |end| end + 1);
        let line = &self.text[line_start..at];
        line.trim_start().starts_with('#') || line.contains(" #")
    }
}
