//! Lists of names in a sentence.

/// [`listed`] and [`shortened`] name no more than this.
const MOST: usize = 10;

/// `` `a`, `b`, `c` ``: all names, in the order given.
pub fn quoted_list<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    quoted(names).collect::<Vec<_>>().join(", ")
}

/// `` `a`, `b` and 3 more``: at most ten names, in the order given.
pub fn listed<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let mut names = names.into_iter();
    let shown: Vec<String> = quoted(names.by_ref().take(MOST)).collect();
    with_rest(&shown, names.count())
}

/// Like [`listed`], for items that carry their own quotes: `` `events` (pub), `commands` (rep)``.
pub fn shortened(items: &[String]) -> String {
    let shown = &items[..items.len().min(MOST)];
    with_rest(shown, items.len() - shown.len())
}

/// `` `a`, `b` or `c` ``: the choices of a question.
pub fn either<S: AsRef<str>>(names: &[S]) -> String {
    joined(names, "or")
}

/// `` `a`, `b` and `c` ``.
pub fn all_of<S: AsRef<str>>(names: &[S]) -> String {
    joined(names, "and")
}

fn joined<S: AsRef<str>>(names: &[S], conjunction: &str) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => {
            format!("{} {conjunction} `{}`", quoted_list(first), last.as_ref())
        }
        _ => quoted_list(names),
    }
}

fn quoted<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> impl Iterator<Item = String> {
    names.into_iter().map(|name| format!("`{}`", name.as_ref()))
}

fn with_rest(shown: &[String], rest: usize) -> String {
    match rest {
        0 => shown.join(", "),
        rest => format!("{} and {rest} more", shown.join(", ")),
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
        assert!(quoted_list(&names).ends_with("`11`, `12`"));
    }

    #[test]
    fn choices_end_with_or() {
        assert_eq!(either::<&str>(&[]), "");
        assert_eq!(either(&["a"]), "`a`");
        assert_eq!(either(&["a", "b", "c"]), "`a`, `b` or `c`");
        assert_eq!(all_of(&["a", "b", "c"]), "`a`, `b` and `c`");
    }
}
