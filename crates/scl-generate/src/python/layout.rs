//! Line breaks as `ruff format` sets them: if a bracket does not fit on its line, its content is moved to lines of its
//! own, either all on one line or one line per element.

/// Maximum length of a line.
const WIDTH: usize = 88;

/// A piece of code.
#[derive(Debug, Clone)]
pub(super) enum Doc {
    Text(String),
    Concat(Vec<Doc>),
    /// Elements in brackets.
    Group {
        open: &'static str,
        elements: Vec<Doc>,
        close: &'static str,
    },
}

impl Doc {
    pub(super) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    pub(super) fn concat(parts: impl IntoIterator<Item = Doc>) -> Self {
        Self::Concat(parts.into_iter().collect())
    }

    pub(super) fn group(open: &'static str, elements: Vec<Doc>, close: &'static str) -> Self {
        Self::Group { open, elements, close }
    }

    /// Formats the code on one line.
    pub(super) fn flat(&self) -> String {
        match self {
            Doc::Text(text) => text.clone(),
            Doc::Concat(parts) => parts.iter().map(Doc::flat).collect(),
            Doc::Group { open, elements, close } => format!("{open}{}{close}", flat_list(elements)),
        }
    }
}

fn flat_list(elements: &[Doc]) -> String {
    elements.iter().map(Doc::flat).collect::<Vec<_>>().join(", ")
}

/// Prints pieces of code that begin at some depth of indentation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    depth: usize,
}

impl Layout {
    /// Creates a layout for code at a depth, in levels of four spaces.
    pub(super) fn at(depth: usize) -> Self {
        Self { depth }
    }

    /// Formats a piece of code. Its lines are indented relative to the depth; the first line is not indented.
    pub(super) fn print(self, doc: &Doc) -> String {
        self.print_before(doc, 0)
    }

    /// Formats an import, whose name gets brackets and a comma if the line is too long.
    pub(super) fn import(self, from: &str, name: &str) -> String {
        let line = format!("{from}{name}");
        if self.fits(&line, 0) { line } else { format!("{from}(\n    {name},\n)") }
    }

    /// Formats a piece of code with room for `after` characters behind it.
    fn print_before(self, doc: &Doc, after: usize) -> String {
        let flat = doc.flat();
        if self.fits(&flat, after) {
            return flat;
        }
        let Some((before, elements, [open, close], behind)) = split(doc) else { return flat };
        let inner = Self { depth: self.depth + 1 };
        let list = flat_list(&elements);
        // As ruff formats it: without a trailing comma if all elements fit on one line, else one element per line, each
        // with a comma.
        let lines = if inner.fits(&list, 0) {
            vec![list]
        } else {
            elements.iter().map(|it| inner.print_before(it, 1) + ",").collect()
        };
        let indented = lines.join("\n").replace('\n', "\n    ");
        format!("{before}{open}\n    {indented}\n{close}{behind}")
    }

    fn fits(self, line: &str, after: usize) -> bool {
        self.depth * 4 + line.chars().count() + after <= WIDTH
    }
}

/// Splits a piece of code at its first group: what is before it, its elements, its brackets, and what is behind it.
fn split(doc: &Doc) -> Option<(String, Vec<Doc>, [&'static str; 2], String)> {
    match doc {
        Doc::Text(_) => None,
        Doc::Group { open, elements, close } => {
            (!elements.is_empty()).then(|| (String::new(), elements.clone(), [*open, *close], String::new()))
        }
        Doc::Concat(parts) => parts.iter().enumerate().find_map(|(at, part)| {
            let (before, elements, brackets, behind) = split(part)?;
            let all_before: String = parts[..at].iter().map(Doc::flat).collect();
            let all_behind: String = parts[at + 1..].iter().map(Doc::flat).collect();
            Some((all_before + &before, elements, brackets, behind + &all_behind))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::{Doc, Layout};

    fn call(arguments: usize, width: usize) -> String {
        let argument = Doc::text("x".repeat(width));
        let call = [Doc::text("f"), Doc::group("(", vec![argument; arguments], ")"), Doc::text(": ...")];
        Layout::at(0).print(&Doc::concat(call))
    }

    #[test]
    fn a_bracket_is_opened_when_its_line_is_too_long() {
        assert_eq!(call(1, 80), format!("f({}): ...", "x".repeat(80)));
        assert_eq!(call(1, 81), format!("f(\n    {}\n): ...", "x".repeat(81)));
        assert_eq!(call(2, 41), format!("f(\n    {0}, {0}\n): ...", "x".repeat(41)));
        assert_eq!(call(2, 42), format!("f(\n    {0},\n    {0},\n): ...", "x".repeat(42)));
    }
}
