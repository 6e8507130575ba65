//! Paths of fields: `pose.joints[0].angle`.

use crate::value::{Value, key_text};
use scl_terminal::Problem;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The way to a value inside a message: names of fields and keys of maps, separated by dots, and indices of lists.
///
/// A name with characters other than letters, digits, `_`, `-` and `@` stands in quotes: `limits."front left"`, or
/// `limits["front left"]`. The empty path is the message itself; its text is `.`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub struct FieldPath {
    segments: Vec<Segment>,
}

#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum Segment {
    Name(String),
    Index(usize),
}

/// A text is not a field path.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{text}` is not a field path: {reason}")]
pub struct PathError {
    text: String,
    reason: String,
}

impl FieldPath {
    /// The value at this path; `None` if the message has none there.
    pub fn find<'v>(&self, value: &'v Value) -> Option<&'v Value> {
        self.segments.iter().try_fold(value, |value, segment| match (segment, value) {
            (Segment::Name(name), value) => value.get(name),
            (Segment::Index(index), Value::List(items)) => items.get(*index),
            (Segment::Index(index), map) => map.get(&index.to_string()),
        })
    }

    /// The path of a field of the value at this path.
    #[must_use]
    pub fn field(mut self, name: &str) -> Self {
        self.segments.push(Segment::Name(name.to_owned()));
        self
    }

    /// The path of an element of the list at this path.
    #[must_use]
    pub fn element(mut self, index: usize) -> Self {
        self.segments.push(Segment::Index(index));
        self
    }

    /// Returns true for the message itself.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Whether this path is `other` or lies below it.
    pub fn starts_with(&self, other: &FieldPath) -> bool {
        self.segments.starts_with(&other.segments)
    }

    /// The paths of the parts of a value that are not maps, or are empty ones, as columns of a table.
    pub fn leaves(value: &Value) -> Vec<FieldPath> {
        let mut leaves = Vec::new();
        add_leaves(value, &FieldPath::default(), &mut leaves);
        leaves
    }

    pub(crate) fn segments(&self) -> &[Segment] {
        &self.segments
    }

    pub(crate) fn up_to(&self, count: usize) -> FieldPath {
        FieldPath { segments: self.segments.iter().take(count).cloned().collect() }
    }

    /// Reads a path at the start of a text, and returns what follows it.
    pub(crate) fn read(text: &str) -> Result<(Self, &str), String> {
        let mut path = FieldPath::default();
        let mut rest = text;
        loop {
            let after_dot = match rest.strip_prefix('.') {
                _ if path.is_empty() => Some(rest),
                after => after,
            };
            if let Some(inner) = rest.strip_prefix('[') {
                let (segment, after) = read_brackets(inner)?;
                path.segments.push(segment);
                rest = after;
            } else if let Some(after) = after_dot {
                let (name, after) =
                    if after.starts_with(['"', '\'']) { read_quoted(after)? } else { read_name(after)? };
                path.segments.push(Segment::Name(name));
                rest = after;
            } else {
                return Ok((path, rest));
            }
        }
    }
}

fn read_name(text: &str) -> Result<(String, &str), String> {
    let end = text.find(|c: char| !is_name_character(c)).unwrap_or(text.len());
    let (name, rest) = text.split_at(end);
    match (name, rest.chars().next()) {
        ("", None) => Err("a name is missing at its end".to_owned()),
        ("", Some(other)) => Err(format!("a name is expected before `{other}`")),
        _ => Ok((name.to_owned(), rest)),
    }
}

fn is_name_character(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '-' | '@')
}

/// Reads a quoted text, in which `\` escapes the next character, and returns what follows it.
pub(crate) fn read_quoted(text: &str) -> Result<(String, &str), String> {
    let mut characters = text.char_indices();
    let quote = characters.next().map(|(_, quote)| quote);
    let mut read = String::new();
    while let Some((at, c)) = characters.next() {
        match c {
            '\\' => read.extend(characters.next().map(|(_, c)| c)),
            c if Some(c) == quote => return Ok((read, &text[at + c.len_utf8()..])),
            c => read.push(c),
        }
    }
    Err("a quote is not closed".to_owned())
}

fn read_brackets(text: &str) -> Result<(Segment, &str), String> {
    let (segment, rest) = if text.starts_with(['"', '\'']) {
        let (name, rest) = read_quoted(text)?;
        (Segment::Name(name), rest)
    } else {
        let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let index = text[..end].parse().map_err(|_| "an index is a number: `[0]`".to_owned())?;
        (Segment::Index(index), &text[end..])
    };
    let rest = rest.strip_prefix(']').ok_or_else(|| "a `]` is missing".to_owned())?;
    Ok((segment, rest))
}

fn add_leaves(value: &Value, above: &FieldPath, leaves: &mut Vec<FieldPath>) {
    match value {
        Value::Map(entries) if !entries.is_empty() => {
            entries.iter().for_each(|(key, value)| add_leaves(value, &above.clone().field(&key_text(key)), leaves));
        }
        _ => leaves.push(above.clone()),
    }
}

impl FromStr for FieldPath {
    type Err = PathError;

    fn from_str(text: &str) -> Result<Self, PathError> {
        let wrong = |reason| PathError { text: text.to_owned(), reason };
        if text == "." {
            return Ok(FieldPath::default());
        }
        match FieldPath::read(text) {
            Ok((path, "")) => Ok(path),
            Ok((_, rest)) => Err(wrong(format!("`{rest}` is not part of a name; put such a name in quotes"))),
            Err(reason) => Err(wrong(reason)),
        }
    }
}

impl fmt::Display for FieldPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.segments.is_empty() {
            return f.write_str(".");
        }
        for (place, segment) in self.segments.iter().enumerate() {
            match segment {
                Segment::Index(index) => write!(f, "[{index}]")?,
                Segment::Name(name) => {
                    let dot = if place == 0 { "" } else { "." };
                    if !name.is_empty() && name.chars().all(is_name_character) {
                        write!(f, "{dot}{name}")?;
                    } else {
                        write!(f, "{dot}\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl From<PathError> for Problem {
    fn from(error: PathError) -> Self {
        Problem::new(error.to_string()).help("write `a.b`, `list[0].c` or `map.\"any key\"`")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_yaml;
    use proptest::prelude::*;

    #[test]
    fn a_path_finds_fields_elements_and_keys() {
        let value = read_yaml("{a: {b: [1, {c: 2}]}, 'x.y': 3, 7: {true: 4}}").unwrap();
        let cases = [
            ("a.b[0]", Some(1)),
            ("a.b[1].c", Some(2)),
            ("a[\"b\"][1].c", Some(2)),
            ("\"x.y\"", Some(3)),
            ("['x.y']", Some(3)),
            ("7.true", Some(4)),
            ("[7].true", Some(4)),
            ("a.b[2]", None),
            ("a.c", None),
            ("a.b.c", None),
        ];
        for (path, expected) in cases {
            let path: FieldPath = path.parse().unwrap();
            assert_eq!(path.find(&value), expected.map(Value::Int).as_ref(), "{path}");
        }
        assert_eq!(".".parse::<FieldPath>().unwrap().find(&value), Some(&value));
    }

    #[test]
    fn a_text_that_is_no_path_says_why() {
        let cases = [
            ("", "a name is missing at its end"),
            ("a.", "a name is missing at its end"),
            ("a..b", "a name is expected before `.`"),
            ("a[x]", "an index is a number: `[0]`"),
            ("a[-1]", "an index is a number: `[0]`"),
            ("a[99999999999999999999]", "an index is a number: `[0]`"),
            ("a[0", "a `]` is missing"),
            ("a.\"b", "a quote is not closed"),
            ("a b", "` b` is not part of a name; put such a name in quotes"),
        ];
        for (text, expected) in cases {
            assert_eq!(text.parse::<FieldPath>().unwrap_err().reason, expected, "{text}");
        }
    }

    proptest! {
        #[test]
        fn the_text_of_a_path_is_the_path(segments in prop::collection::vec(
            prop_oneof![".*".prop_map(Segment::Name), any::<usize>().prop_map(Segment::Index)], 0..5)
        ) {
            let path = FieldPath { segments };
            prop_assert_eq!(path.to_string().parse::<FieldPath>(), Ok(path));
        }

        #[test]
        fn no_text_panics(text in ".*") {
            let _ = text.parse::<FieldPath>();
        }
    }
}
