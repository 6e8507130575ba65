//! The names that a misspelt word may have meant.

use crate::grammar::{GateKind, KindRow};
use crate::work;
use strsim::damerau_levenshtein;

/// No message offers more names than this.
pub(crate) const MOST: usize = 3;

/// Longer words, in bytes, are not compared: the comparison takes quadratic time.
const LONGEST: usize = 128;

/// The start of a name is a hint only from this many letters on.
const ABBREVIATION: usize = 3;

/// The candidates that look most like `word`, at most three.
///
/// A candidate that differs only in case is the nearest; the others are within a third of the word's length of edits,
/// at least one, or start with the word. All that are given are equally near, and keep their order.
pub fn similar<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut nearest = nearest(word, candidates);
    nearest.truncate(MOST);
    nearest
}

/// Like [`similar`], but all that are equally near, so that the caller can choose among them.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let lower = word.to_lowercase();
    // Every other word of one letter is one edit away.
    let length = word.chars().count();
    let limit = (length / 3).max(1).min(length.saturating_sub(1));
    let mut near: Vec<(usize, &'a str)> = candidates
        .into_iter()
        .filter(|candidate| *candidate != word)
        .filter_map(|candidate| {
            distance(&lower, &candidate.to_lowercase(), limit).map(|distance| (distance, candidate))
        })
        .collect();
    near.sort_by_key(|(distance, _)| *distance);
    // Beside one that is nearer, the others are noise.
    let nearest = near.first().map_or(0, |(distance, _)| *distance);
    near.retain(|(distance, _)| *distance == nearest);
    near.dedup();
    near.into_iter().map(|(_, candidate)| candidate).collect()
}

/// The candidates that one typing error makes of a word, at most three.
pub(crate) fn one_edit_away<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    candidates.into_iter().filter(|candidate| distance(word, candidate, 1) == Some(1)).take(MOST).collect()
}

/// The kinds of gate that a word may have meant, at most three: in another case, by another name, or misspelt by one
/// letter.
pub(crate) fn kind(word: &str) -> Vec<&'static str> {
    let lower = word.to_lowercase();
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

/// How far two lower-case words are apart, if not more than `limit`.
fn distance(word: &str, candidate: &str, limit: usize) -> Option<usize> {
    // An abbreviation, such as `que` for `queue`, is as good as the last typing error that we accept, or better.
    if word.len() >= ABBREVIATION && candidate.len() > word.len() && candidate.starts_with(word) {
        return Some(limit.min(candidate.chars().count() - word.chars().count()));
    }
    // A difference in length is a lower bound, and cheap: it keeps long lists of names fast.
    if word.len().max(candidate.len()) > LONGEST || word.chars().count().abs_diff(candidate.chars().count()) > limit {
        return None;
    }
    let (word, candidate) = without_common_ends(word, candidate);
    work::add(1 + word.len() * candidate.len());
    let distance = match word.is_empty() || candidate.is_empty() {
        true => word.chars().count().max(candidate.chars().count()),
        false => damerau_levenshtein(word, candidate),
    };
    Some(distance).filter(|distance| *distance <= limit)
}

/// What is left of two words without their common start and end, which do not change the distance: names of one file
/// often differ by a number only, and the comparison takes quadratic time.
fn without_common_ends<'a>(one: &'a str, other: &'a str) -> (&'a str, &'a str) {
    let same = |(one, other): &(char, char)| one == other;
    let start: usize = one.chars().zip(other.chars()).take_while(same).map(|(letter, _)| letter.len_utf8()).sum();
    let (one, other) = (&one[start..], &other[start..]);
    let end: usize =
        one.chars().rev().zip(other.chars().rev()).take_while(same).map(|(letter, _)| letter.len_utf8()).sum();
    (&one[..one.len() - end], &other[..other.len() - end])
}

#[cfg(test)]
mod tests {
    use super::{LONGEST, kind, same_parts, similar, without_common_ends};

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
    fn parts_in_another_order_are_found() {
        let types = ["uav.Measurement", "uav.Status", "log.Status"];
        assert_eq!(same_parts("Measurement.uav", types), ["uav.Measurement"]);
        assert_eq!(same_parts("Status", types), ["uav.Status", "log.Status"]);
        assert!(same_parts("Command", types).is_empty());
    }

    #[test]
    fn only_what_differs_is_compared() {
        for (one, other, left) in [
            ("sensor_12", "sensor_21", ("12", "21")),
            ("aab", "aba", ("ab", "ba")),
            ("aa", "a", ("a", "")),
            ("größe", "grüße", ("ö", "ü")),
            ("same", "same", ("", "")),
        ] {
            assert_eq!(without_common_ends(one, other), left, "{one} {other}");
        }
        assert!(similar(&"a".repeat(LONGEST + 1), ["a".repeat(LONGEST).as_str()]).is_empty());
    }

    #[test]
    fn nearest_names_come_first() {
        let cases: [(&str, &[&str], &[&str]); 11] = [
            ("publ", &["pub", "sub", "push", "pull"], &["pub", "pull"]),
            ("Gates", &["name", "gates"], &["gates"]),
            ("conections", &["components", "connections"], &["connections"]),
            ("measuremnets", &["measurements"], &["measurements"]),
            ("que", &["share", "queue"], &["queue"]),
            ("xyz", &["measurements"], &[]),
            ("ab", &["b", "ac", "ad", "ae"], &["b", "ac", "ad"]),
            ("pub", &["pub"], &[]),
            ("sensor1_lef", &["sensor2_left", "sensor1_left"], &["sensor1_left"]),
            ("vehicle1_filte", &["vehicle0_filter", "vehicle1_filter", "vehicle2_filter"], &["vehicle1_filter"]),
            (
                "sensor3_left",
                &["sensor1_left", "sensor2_left", "sensor33_left"],
                &["sensor1_left", "sensor2_left", "sensor33_left"],
            ),
        ];
        for (word, candidates, expected) in cases {
            assert_eq!(similar(word, candidates.iter().copied()), expected, "{word}");
        }
    }
}
