//! The names that a misspelt word may have meant.

use strsim::damerau_levenshtein;

/// No message offers more names than this.
const MOST: usize = 3;

/// The start of a name is a hint only from this many letters on.
const ABBREVIATION: usize = 3;

/// The candidates that look like `word`, the nearest first, at most three.
///
/// A candidate that differs only in case comes first; the others are within a third of the word's length of edits,
/// at least one, or start with the word. Candidates that are equally near keep their order.
pub(crate) fn similar<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let lower = word.to_lowercase();
    let limit = (word.chars().count() / 3).max(1);
    let mut near: Vec<(usize, &'a str)> = candidates
        .into_iter()
        .filter(|candidate| *candidate != word)
        .filter_map(|candidate| {
            distance(&lower, &candidate.to_lowercase(), limit).map(|distance| (distance, candidate))
        })
        .collect();
    near.sort_by_key(|(distance, _)| *distance);
    near.dedup();
    near.truncate(MOST);
    near.into_iter().map(|(_, candidate)| candidate).collect()
}

/// How far two lower-case words are apart, if not more than `limit`.
fn distance(word: &str, candidate: &str, limit: usize) -> Option<usize> {
    // An abbreviation, such as `que` for `queue`, is as good as the last typing error that we accept.
    if word.len() >= ABBREVIATION && candidate.len() > word.len() && candidate.starts_with(word) {
        return Some(limit);
    }
    // A difference in length is a lower bound, and cheap: it keeps long lists of names fast.
    if word.chars().count().abs_diff(candidate.chars().count()) > limit {
        return None;
    }
    Some(damerau_levenshtein(word, candidate)).filter(|distance| *distance <= limit)
}

#[cfg(test)]
mod tests {
    use super::similar;

    #[test]
    fn nearest_names_come_first() {
        let cases: [(&str, &[&str], &[&str]); 8] = [
            ("publ", &["pub", "sub", "push", "pull"], &["pub", "pull"]),
            ("Gates", &["name", "gates"], &["gates"]),
            ("conections", &["components", "connections"], &["connections"]),
            ("measuremnets", &["measurements"], &["measurements"]),
            ("que", &["share", "queue"], &["queue"]),
            ("xyz", &["measurements"], &[]),
            ("a", &["b", "c", "d", "e"], &["b", "c", "d"]),
            ("pub", &["pub"], &[]),
        ];
        for (word, candidates, expected) in cases {
            assert_eq!(similar(word, candidates.iter().copied()), expected, "{word}");
        }
    }
}
