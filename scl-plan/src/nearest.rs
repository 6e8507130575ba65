//! Suggestions for misspelt names.

/// The name that `wrong` was most likely meant to be, if one is near enough: at most a third of its letters differ.
///
/// Of equally near names, the first.
pub fn nearest<'n>(wrong: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let limit = (wrong.chars().count() / 3).max(1);
    let measured = names.into_iter().map(|name| (distance(wrong, name), name));
    let near = measured.filter(|&(distance, _)| distance <= limit);
    near.min_by_key(|&(distance, _)| distance).map(|(_, name)| name)
}

/// The number of letters to insert, delete, replace or swap with the next one (Damerau-Levenshtein, restricted).
fn distance(one: &str, other: &str) -> usize {
    let (one, other): (Vec<char>, Vec<char>) = (one.chars().collect(), other.chars().collect());
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=other.len()).collect();
    for (row, &letter) in one.iter().enumerate() {
        let mut current = vec![row + 1];
        for (column, &wanted) in other.iter().enumerate() {
            let replaced = above[column] + usize::from(letter != wanted);
            let mut least = replaced.min(above[column + 1] + 1).min(current[column] + 1);
            if row > 0 && column > 0 && letter == other[column - 1] && one[row - 1] == wanted {
                least = least.min(before[column - 1] + 1);
            }
            current.push(least);
        }
        before = std::mem::replace(&mut above, current);
    }
    above[other.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_single_mistakes() {
        for (one, other, expected) in
            [("", "", 0), ("", "ab", 2), ("sensor", "sensor", 0), ("sensor", "snesor", 1), ("sensr", "sensor", 1)]
        {
            assert_eq!((distance(one, other), distance(other, one)), (expected, expected), "{one} {other}");
        }
    }

    #[test]
    fn only_near_names_are_suggested() {
        let names = ["sensor", "sensors", "actuator"];
        for (wrong, expected) in
            [("sensr", Some("sensor")), ("actator", Some("actuator")), ("display", None), ("", None)]
        {
            assert_eq!(nearest(wrong, names), expected, "{wrong}");
        }
        assert_eq!(nearest("b", ["a", "c"]), Some("a"), "the first of equally near ones");
    }
}
