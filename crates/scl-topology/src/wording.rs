//! How messages list names in a sentence.

/// No note names more than this.
const MOST: usize = 10;

/// `` `a`, `b` and 3 more``: at most ten names, in the order given.
pub(crate) fn listed<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let mut names = names.into_iter();
    let shown: Vec<String> = names.by_ref().take(MOST).map(|name| format!("`{}`", name.as_ref())).collect();
    with_rest(&shown, names.count())
}

/// Like [`listed`], for items that carry their own quotes: `` `events` (pub), `commands` (rep)``.
pub(crate) fn shortened(items: &[String]) -> String {
    let shown = &items[..items.len().min(MOST)];
    with_rest(shown, items.len() - shown.len())
}

fn with_rest(shown: &[String], rest: usize) -> String {
    match rest {
        0 => shown.join(", "),
        rest => format!("{} and {rest} more", shown.join(", ")),
    }
}

/// `` `a`, `b` or `c` ``: the choices of a question.
pub(crate) fn either<S: AsRef<str>>(names: &[S]) -> String {
    joined(names, "or")
}

/// `` `a`, `b` and `c` ``.
pub(crate) fn all_of<S: AsRef<str>>(names: &[S]) -> String {
    joined(names, "and")
}

fn joined<S: AsRef<str>>(names: &[S], conjunction: &str) -> String {
    let mut text = String::new();
    for (at, name) in names.iter().enumerate() {
        match at {
            0 => {}
            _ if at + 1 == names.len() => text.push_str(&format!(" {conjunction} ")),
            _ => text.push_str(", "),
        }
        text.push_str(&format!("`{}`", name.as_ref()));
    }
    text
}

/// A type name that would suit a gate, for examples that can be pasted: `measurements` gives `Measurement`.
pub(crate) fn example_type(gate: &str) -> String {
    let name = crate::rust_name::component_type(gate);
    match name.strip_suffix('s') {
        Some(singular) if singular.len() > 1 && !singular.ends_with(['s', 'u', 'i']) => singular.to_owned(),
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_stop_after_ten() {
        assert_eq!(listed(["a", "b"]), "`a`, `b`");
        let names: Vec<String> = (0..13).map(|n| n.to_string()).collect();
        assert!(listed(&names).ends_with("`9` and 3 more"));
        assert!(listed(&names[..10]).ends_with(", `9`"));
    }

    #[test]
    fn choices_end_with_or() {
        assert_eq!(either(&["a"]), "`a`");
        assert_eq!(either(&["a", "b", "c"]), "`a`, `b` or `c`");
        assert_eq!(all_of(&["a", "b", "c"]), "`a`, `b` and `c`");
    }

    #[test]
    fn example_types_are_singular() {
        for (gate, expected) in [
            ("measurements", "Measurement"),
            ("set-point", "SetPoint"),
            ("pass", "Pass"),
            ("status", "Status"),
            ("s", "S"),
        ] {
            assert_eq!(example_type(gate), expected);
        }
    }
}
