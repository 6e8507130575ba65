//! The names of a topology that a misspelt word may have meant.

use crate::grammar::{GateKind, KindRow};
use crate::habits;
use crate::work;
pub(crate) use scl_text::suggest::MOST;

/// The other names that look most like `word`, at most three; see [`scl_text::suggest::nearest`].
pub fn similar<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut nearest = nearest(word, candidates);
    nearest.truncate(MOST);
    nearest
}

/// Like [`similar`], but all that are equally near, so that the caller can choose among them.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let others = candidates.into_iter().filter(|candidate| *candidate != word);
    scl_text::suggest::nearest(word, others, work::add)
}

/// How many more unknown names may be compared with all others: each reads all of them, so in a file with very many
/// mistakes the later ones do without, and time stays linear.
#[derive(Debug)]
pub(crate) struct Searches(usize);

impl Default for Searches {
    fn default() -> Self {
        Self(20)
    }
}

impl Searches {
    pub(crate) fn new(most: usize) -> Self {
        Self(most)
    }

    /// Counts a search, and returns whether it may take place.
    pub(crate) fn may_search(&mut self) -> bool {
        let may_search = self.0 > 0;
        self.0 = self.0.saturating_sub(1);
        may_search
    }

    /// [`similar`] names, or none if no search is left.
    pub(crate) fn similar<'n>(&mut self, word: &str, names: impl IntoIterator<Item = &'n str>) -> Vec<&'n str> {
        if self.may_search() { similar(word, names) } else { Vec::new() }
    }
}

/// The candidates that one typing error makes of a word, at most three.
pub(crate) fn one_edit_away<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    scl_text::suggest::one_edit_away(word, candidates, work::add).take(MOST).collect()
}

/// The kinds of gate that a word may have meant, at most three: in another case, by another name, or misspelt by one
/// letter.
pub(crate) fn kind(word: &str) -> Vec<&'static str> {
    let lower = habits::compact(word);
    let is_called = |kind: &GateKind| kind.word() == lower || KindRow::of(*kind).synonyms.contains(&lower.as_str());
    match GateKind::ALL.into_iter().find(is_called) {
        Some(kind) => vec![kind.word()],
        None => similar(word, GateKind::ALL.map(GateKind::word)),
    }
}

/// The candidates that consist of the same parts in another order, or that end with the same part:
/// `Measurement` and `Measurement.uav` may have meant `uav.Measurement`.
pub(crate) fn same_parts<'a>(dotted: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let parts = sorted_parts(dotted);
    let last = dotted.rsplit('.').next();
    let fits = |candidate: &&str| sorted_parts(candidate) == parts || candidate.rsplit('.').next() == last;
    candidates.into_iter().filter(fits).take(MOST).collect()
}

fn sorted_parts(dotted: &str) -> Vec<String> {
    let mut parts: Vec<String> = dotted.split('.').map(str::to_lowercase).collect();
    parts.sort();
    parts
}

#[cfg(test)]
mod tests {
    use super::{kind, same_parts, similar};

    #[test]
    fn kinds_have_other_names() {
        let cases: [(&str, &[&str]); 6] = [
            ("subscribe", &["sub"]),
            ("PUB", &["pub"]),
            ("server", &["rep"]),
            ("sbu", &["sub"]),
            ("pusj", &["push"]),
            ("teapot", &[]),
        ];
        for (word, expected) in cases {
            assert_eq!(kind(word), expected, "{word}");
        }
    }

    #[test]
    fn at_most_three_other_names_are_offered() {
        assert!(similar("pub", ["pub"]).is_empty());
        assert_eq!(similar("ab", ["b", "ac", "ad", "ae"]), ["b", "ac", "ad"]);
    }

    #[test]
    fn parts_in_another_order_are_found() {
        let types = ["uav.Measurement", "uav.Status", "log.Status"];
        assert_eq!(same_parts("Measurement.uav", types), ["uav.Measurement"]);
        assert_eq!(same_parts("Status", types), ["uav.Status", "log.Status"]);
        assert!(same_parts("Command", types).is_empty());
    }
}
