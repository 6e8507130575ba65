//! Suggestions for misspelt names.

use strsim::osa_distance;

/// The name that `wrong` was most likely meant to be, if one is near enough: at most a third of its letters differ.
///
/// Of equally near names, the first.
pub fn nearest<'n>(wrong: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let limit = (wrong.chars().count() / 3).max(1);
    let measured = names.into_iter().map(|name| (osa_distance(wrong, name), name));
    let near = measured.filter(|&(distance, _)| distance <= limit);
    near.min_by_key(|&(distance, _)| distance).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_single_mistakes() {
        for (one, other, expected) in
            [("", "", 0), ("", "ab", 2), ("sensor", "sensor", 0), ("sensor", "snesor", 1), ("sensr", "sensor", 1)]
        {
            assert_eq!((osa_distance(one, other), osa_distance(other, one)), (expected, expected), "{one} {other}");
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
