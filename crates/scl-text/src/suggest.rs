//! The names that a misspelt word may have meant.

use strsim::damerau_levenshtein;

/// No message offers more names than this.
pub const MOST: usize = 3;

/// Longer words, in bytes, are not compared: the comparison takes quadratic time.
const LONGEST: usize = 128;

/// Minimum length of a word, in bytes, to count as the abbreviation of a name that starts with it.
const ABBREVIATION: usize = 3;

/// The candidate that looks most like `word`, if one is near enough; see [`nearest`]. Of equally near ones, the first.
pub fn closest_name<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    nearest(word, candidates, |_| ()).first().copied()
}

/// The candidates that look most like `word`.
///
/// A candidate that differs only in case is the nearest. Others start with the word, end with it after a dot, or are
/// within a third of its length in edits (one edit for a word of two letters). All that are returned are equally near,
/// and keep their order. `count_steps` receives the cost of each comparison.
pub fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
    count_steps: impl Fn(usize),
) -> Vec<&'a str> {
    let lower = word.to_lowercase();
    // Allow no edits to a word of one letter: any other letter is one edit away.
    let length = word.chars().count();
    let limit = (length / 3).max(1).min(length.saturating_sub(1));
    let mut near: Vec<(usize, &'a str)> = candidates
        .into_iter()
        .filter_map(|candidate| {
            distance(&lower, &candidate.to_lowercase(), limit, &count_steps).map(|distance| (distance, candidate))
        })
        .collect();
    near.sort_by_key(|(distance, _)| *distance);
    // Keep only the nearest candidates; the others are noise.
    let nearest = near.first().map_or(0, |(distance, _)| *distance);
    near.retain(|(distance, _)| *distance == nearest);
    near.dedup();
    near.into_iter().map(|(_, candidate)| candidate).collect()
}

/// The candidates that differ from a word by one typing error. `count_steps` receives the cost of each comparison.
pub fn one_edit_away<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
    count_steps: impl Fn(usize),
) -> impl Iterator<Item = &'a str> {
    candidates.into_iter().filter(move |candidate| distance(word, candidate, 1, &count_steps) == Some(1))
}

/// The number of edits between two lower-case words; `None` if it is more than `limit`.
fn distance(word: &str, candidate: &str, limit: usize, count_steps: impl Fn(usize)) -> Option<usize> {
    // An abbreviation, such as `que` for `queue`, counts as at most `limit` edits, however much is missing. So does
    // `planner` for `left_arm.planner`, which is in a group.
    let is_own_name = || candidate.strip_suffix(word).is_some_and(|group| group.ends_with('.'));
    let is_part = candidate.len() > word.len() && (candidate.starts_with(word) || is_own_name());
    if word.len() >= ABBREVIATION && is_part {
        return Some(limit.min(candidate.chars().count() - word.chars().count()));
    }
    // A difference in length is a lower bound, and cheap: it keeps long lists of names fast.
    if word.len().max(candidate.len()) > LONGEST || word.chars().count().abs_diff(candidate.chars().count()) > limit {
        return None;
    }
    let (word, candidate) = without_common_ends(word, candidate);
    count_steps(1 + word.len() * candidate.len());
    let distance = match word.is_empty() || candidate.is_empty() {
        true => word.chars().count().max(candidate.chars().count()),
        false => damerau_levenshtein(word, candidate),
    };
    Some(distance).filter(|distance| *distance <= limit)
}

/// Returns two words without their common start and end, which do not change the distance. This saves time: names in
/// one file often differ by a number only, and the comparison takes quadratic time.
fn without_common_ends<'a>(one: &'a str, other: &'a str) -> (&'a str, &'a str) {
    let same = |(one, other): &(char, char)| one == other;
    let start: usize = one.chars().zip(other.chars()).take_while(same).map(|(letter, _)| letter.len_utf8()).sum();
    let (one, other) = (&one[start..], &other[start..]);
    let end: usize =
        one.chars().rev().zip(other.chars().rev()).take_while(same).map(|(letter, _)| letter.len_utf8()).sum();
    (&one[..one.len() - end], &other[..other.len() - end])
}

/// A word without case and marks: `GpsFix`, `gps_fix` and `gps-fix` are the same.
pub fn bare(word: &str) -> String {
    word.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// `true` or `false` in the words of other formats, in lower case.
pub fn boolean(word: &str) -> Option<&'static str> {
    match word {
        "true" | "yes" | "y" | "on" | "1" | "t" | "enabled" | "enable" => Some("true"),
        "false" | "no" | "n" | "off" | "0" | "f" | "disabled" | "disable" => Some("false"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(closest_name(&"a".repeat(LONGEST + 1), ["a".repeat(LONGEST).as_str()]), None);
    }

    #[test]
    fn nearest_names_come_first() {
        let cases: [(&str, &[&str], &[&str]); 20] = [
            ("publ", &["pub", "sub", "push", "pull"], &["pub", "pull"]),
            ("Gates", &["name", "gates"], &["gates"]),
            ("FOLDER", &["command", "environment", "folder"], &["folder"]),
            ("conections", &["components", "connections"], &["connections"]),
            ("comand", &["command", "environment", "folder"], &["command"]),
            ("enviroment", &["command", "environment", "folder"], &["environment"]),
            ("measuremnets", &["measurements"], &["measurements"]),
            ("sensr", &["sensor", "sensors", "actuator"], &["sensor"]),
            ("actator", &["sensor", "sensors", "actuator"], &["actuator"]),
            ("display", &["sensor", "sensors", "actuator"], &[]),
            ("que", &["share", "queue"], &["queue"]),
            ("xyz", &["measurements"], &[]),
            ("x", &["command", "y"], &[]),
            ("", &["sensor", "a"], &[]),
            ("ab", &["b", "ac", "ad", "ae"], &["b", "ac", "ad", "ae"]),
            ("pub", &["pub"], &["pub"]),
            ("snesor", &["sensor"], &["sensor"]),
            ("sensor1_lef", &["sensor2_left", "sensor1_left"], &["sensor1_left"]),
            ("vehicle1_filte", &["vehicle0_filter", "vehicle1_filter", "vehicle2_filter"], &["vehicle1_filter"]),
            (
                "sensor3_left",
                &["sensor1_left", "sensor2_left", "sensor33_left"],
                &["sensor1_left", "sensor2_left", "sensor33_left"],
            ),
        ];
        for (word, candidates, expected) in cases {
            assert_eq!(nearest(word, candidates.iter().copied(), |_| ()), expected, "{word}");
            assert_eq!(closest_name(word, candidates.iter().copied()), expected.first().copied(), "{word}");
        }
    }

    #[test]
    fn the_steps_of_each_comparison_are_counted() {
        let steps = std::cell::Cell::new(0);
        let found: Vec<&str> =
            one_edit_away("SCL0101", ["SCL0102", "SCL0101", "SCL01012"], |more| steps.set(steps.get() + more))
                .collect();
        assert_eq!((found, steps.get()), (vec!["SCL0102", "SCL01012"], 2 + 1));
    }
}
