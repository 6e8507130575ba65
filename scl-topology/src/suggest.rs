//! The names that a misspelt word may have meant.

use strsim::damerau_levenshtein;

/// No message offers more names than this.
const MOST: usize = 3;

/// The candidates that look like `word`, the nearest first, at most three.
///
/// A candidate that differs only in case comes first; the others are within a third of the word's length of edits,
/// at least one. Candidates that are equally near keep their order.
pub(crate) fn similar<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let lower = word.to_lowercase();
    let limit = (word.chars().count() / 3).max(1);
    let mut near: Vec<(usize, &'a str)> = candidates
        .into_iter()
        .filter(|candidate| *candidate != word && lengths_allow(word, candidate, limit))
        .map(|candidate| (damerau_levenshtein(&lower, &candidate.to_lowercase()), candidate))
        .filter(|(distance, _)| *distance <= limit)
        .collect();
    near.sort_by_key(|(distance, _)| *distance);
    near.dedup();
    near.truncate(MOST);
    near.into_iter().map(|(_, candidate)| candidate).collect()
}

/// A difference in length is a lower bound of the distance, and cheap: it keeps long lists of names fast.
fn lengths_allow(word: &str, candidate: &str, limit: usize) -> bool {
    word.chars().count().abs_diff(candidate.chars().count()) <= limit
}

#[cfg(test)]
mod tests {
    use super::similar;

    #[test]
    fn nearest_names_come_first() {
        let cases: [(&str, &[&str], &[&str]); 7] = [
            ("publ", &["pub", "sub", "push", "pull"], &["pub", "pull"]),
            ("Gates", &["name", "gates"], &["gates"]),
            ("conections", &["components", "connections"], &["connections"]),
            ("measuremnets", &["measurements"], &["measurements"]),
            ("xyz", &["measurements"], &[]),
            ("a", &["b", "c", "d", "e"], &["b", "c", "d"]),
            ("pub", &["pub"], &[]),
        ];
        for (word, candidates, expected) in cases {
            assert_eq!(similar(word, candidates.iter().copied()), expected, "{word}");
        }
    }
}
