//! Placeholders in commands: those of the shell, and those of other tools, which nothing replaces here.

use std::ops::Range;

/// What a placeholder stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning<'w> {
    /// The value of a variable, as the shell writes it: `$NAME` or `${NAME}`.
    Shell(&'w str),
    /// The value of a variable in the notation of Kubernetes, of CI files or of ROS.
    Variable(&'w str),
    /// The folder of a ROS package, with the slash behind it.
    Package,
    /// A value that only another tool knows.
    Other,
}

impl Meaning<'_> {
    /// Whether only another tool replaces it. `$(NAME)` is also a command of the shell.
    pub(super) fn is_foreign(self, written: &str, is_known: impl Fn(&str) -> bool) -> bool {
        match self {
            Meaning::Shell(_) => false,
            Meaning::Variable(name) => !written.starts_with("$(") || written.contains(' ') || is_known(name),
            Meaning::Package | Meaning::Other => true,
        }
    }
}

/// The placeholders of a text with their places.
pub(super) fn placeholders(text: &str) -> Vec<(Range<usize>, Meaning<'_>)> {
    let mut found = Vec::new();
    let mut at = text.find('$').unwrap_or(text.len());
    for part in text.split('$').skip(1) {
        let is_escaped = text.get(..at).is_some_and(|before| before.ends_with('\\'));
        if let Some((length, meaning)) = placeholder(part).filter(|_| !is_escaped) {
            found.push((at..at + 1 + length, meaning));
        }
        at += 1 + part.len();
    }
    found
}

/// Writes something else for each placeholder; `None` if there is nothing to write for one of them.
pub(super) fn replaced<'w>(text: &'w str, with: impl Fn(Meaning<'w>) -> Option<String>) -> Option<String> {
    let mut out = String::new();
    let mut at = 0;
    for (range, meaning) in placeholders(text) {
        out.push_str(text.get(at..range.start)?);
        out.push_str(&with(meaning)?);
        at = range.end;
    }
    out.push_str(text.get(at..)?);
    Some(out)
}

/// The placeholder that a text behind `$` begins with, and its length.
fn placeholder(text: &str) -> Option<(usize, Meaning<'_>)> {
    let inner = |open: &str, close: &str| {
        let rest = text.strip_prefix(open)?;
        let end = rest.find(close)?;
        Some((open.len() + end + close.len(), rest.get(..end)?.trim()))
    };
    if let Some((length, inner)) = inner("{{", "}}") {
        let name = ["env.", "vars."].iter().find_map(|scope| inner.strip_prefix(scope));
        return Some((length, name.filter(|name| is_name(name)).map_or(Meaning::Other, Meaning::Variable)));
    }
    if let Some((length, inner)) = inner("{", "}") {
        let name = ["env:", "env."].iter().find_map(|scope| inner.strip_prefix(scope)).filter(|name| is_name(name));
        return match name {
            Some(name) => Some((length, Meaning::Variable(name))),
            None => is_name(inner).then_some((length, Meaning::Shell(inner))),
        };
    }
    if let Some((length, inner)) = inner("(", ")") {
        let is_package = text.get(length..).is_some_and(|rest| rest.starts_with('/'));
        let meaning = match inner.split_whitespace().collect::<Vec<_>>().as_slice() {
            ["find" | "find-pkg-share" | "find-pkg-prefix", _] if is_package => {
                return Some((length + 1, Meaning::Package));
            }
            ["env", name] | ["optenv", name, ..] if is_name(name) => Meaning::Variable(name),
            ["arg" | "var" | "anon" | "find-pkg-share" | "find-pkg-prefix", _] | ["dirname"] => Meaning::Other,
            [name] if is_name(name) && !name.contains(char::is_lowercase) => Meaning::Variable(name),
            _ => return None,
        };
        return Some((length, meaning));
    }
    let length = text.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(text.len());
    let name = text.get(..length).filter(|name| is_name(name))?;
    Some((length, Meaning::Shell(name)))
}

fn is_name(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
        && text.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::Meaning::{Other, Package, Shell, Variable};
    use super::placeholders;

    #[test]
    fn notations_of_other_tools_are_known() {
        for (text, meant) in [
            ("a$HOME/b", &[("$HOME", Shell("HOME"))][..]),
            ("${A}é$B_2", &[("${A}", Shell("A")), ("$B_2", Shell("B_2"))]),
            ("$(A)", &[("$(A)", Variable("A"))]),
            ("${{ env.A }}", &[("${{ env.A }}", Variable("A"))]),
            ("${{ github.sha }}", &[("${{ github.sha }}", Other)]),
            ("${env:A}", &[("${env:A}", Variable("A"))]),
            ("$(find maps)/a.yaml", &[("$(find maps)/", Package)]),
            ("$(env A) $(arg b)", &[("$(env A)", Variable("A")), ("$(arg b)", Other)]),
            ("$(date +%s) $(nproc) $(find . -name a) $1 $? \\$A ${A:-b} ${ $( $", &[]),
        ] {
            let found: Vec<_> = placeholders(text).into_iter().map(|(range, meant)| (&text[range], meant)).collect();
            assert_eq!(found, meant, "{text}");
        }
    }
}
