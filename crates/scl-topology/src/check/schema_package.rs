//! Types that no schema declares, by mistake: one that is made in several places is one group, and so are all types of
//! which only the package is wrong, and in the same way.

use super::draft::Draft;
use super::schema_names::Unknown;
use crate::diagnostic::{Diagnostic, Edit, Rule};
use scl_text::list::listed;
use std::collections::{BTreeSet, HashMap};

/// Maximum number of further places that one problem shows.
const MOST: usize = 8;

/// The packages of a type and of the message that it means, if nothing else differs.
fn packages<'n>(dotted: &'n str, meant: &'n str) -> Option<[&'n str; 2]> {
    let same = dotted.rsplit('.').zip(meant.rsplit('.')).take_while(|(one, other)| one == other);
    let same: usize = same.map(|(part, _)| part.len() + 1).sum();
    let package = |name: &'n str| name.get(..name.len().saturating_sub(same)).unwrap_or_default();
    (same > 0).then(|| [package(dotted), package(meant)])
}

impl Unknown<'_> {
    fn packages(&self) -> Option<[&str; 2]> {
        match self.meant.as_slice() {
            [only] => packages(self.name.dotted(), only),
            _ => None,
        }
    }

    fn edit(&self, draft: &Draft<'_>, to: &str) -> Edit {
        Edit::new(draft.part(self.name.span(), self.name.dotted(), false), to)
    }
}

/// Groups the types in the order of their first places.
pub(super) fn by_mistake(unknown: Vec<Unknown<'_>>) -> Vec<Vec<Unknown<'_>>> {
    let mut of_package: HashMap<[String; 2], BTreeSet<String>> = HashMap::new();
    let key = |packages: [&str; 2]| packages.map(str::to_owned);
    for one in &unknown {
        if let Some(packages) = one.packages() {
            of_package.entry(key(packages)).or_default().insert(one.name.dotted().to_owned());
        }
    }
    let is_shared = |packages: &[&str; 2]| of_package.get(&key(*packages)).is_some_and(|names| names.len() > 1);
    let mut numbers: HashMap<[String; 2], usize> = HashMap::new();
    let mut groups: Vec<Vec<Unknown<'_>>> = Vec::new();
    for one in unknown {
        let of = one.packages().filter(is_shared).map_or_else(|| key([one.name.dotted(), "."]), key);
        let number = *numbers.entry(of).or_insert(groups.len());
        match groups.get_mut(number) {
            Some(group) => group.push(one),
            None => groups.push(vec![one]),
        }
    }
    groups
}

/// The problem of several types that have only a wrong package; `None` for another group. `is_certain` says that no
/// Rust types are meant.
pub(super) fn wrong_package(
    rule: &'static Rule,
    draft: &Draft<'_>,
    group: &[Unknown<'_>],
    is_certain: bool,
) -> Option<Diagnostic> {
    let first = group.first()?;
    let [wrong, right] =
        first.packages().filter(|_| group.iter().any(|one| one.name.dotted() != first.name.dotted()))?;
    let headline = match (wrong, right) {
        (_, "") => format!("the `schemas` declare these types without a package, not in `{wrong}`"),
        ("", _) => format!("the `schemas` declare these types in the package `{right}`"),
        _ => format!("the `schemas` declare these types in the package `{right}`, not `{wrong}`"),
    };
    let names: BTreeSet<&str> = group.iter().flat_map(|one| one.meant.iter().copied()).collect();
    let way = match (wrong, right) {
        ("", _) => "write their package",
        (_, "") => "remove the package",
        _ => "write the other package",
    };
    let edits = group.iter().filter_map(|one| Some(one.edit(draft, one.meant.first()?)));
    let found = rule.at(headline, first.name.span(), "not in the `schemas`");
    let (found, text) = (with_places(found, group), format!("{way}: {}", listed(names)));
    Some(if is_certain { found.propose(text, edits) } else { found.suggest(text, edits) })
}

/// Shows the further places of a group.
pub(super) fn with_places(found: Diagnostic, group: &[Unknown<'_>]) -> Diagnostic {
    let places = group.iter().skip(1).map(|one| (one.name.span(), "and here"));
    let found = found.labels(places.take(MOST));
    match group.len() {
        0 | 1 => found,
        more => found.note(format!("{more} places have it")),
    }
}

/// The changes of all places of a group to another type.
pub(super) fn retyped(draft: &Draft<'_>, group: &[Unknown<'_>], to: &str) -> Vec<Edit> {
    group.iter().map(|one| one.edit(draft, to)).collect()
}

#[cfg(test)]
mod tests {
    use super::packages;

    #[test]
    fn what_stands_before_the_same_end_is_the_package() {
        for (dotted, meant, expected) in [
            ("navigation.Odometry", "nav.Odometry", Some(["navigation", "nav"])),
            ("Odometry", "nav.v1.Odometry", Some(["", "nav.v1"])),
            ("nav.Odometry", "Odometry", Some(["nav", ""])),
            ("nav.v2.Pose.Axis", "nav.v1.Pose.Axis", Some(["nav.v2", "nav.v1"])),
            ("nav.Odom", "nav.Odometry", None),
        ] {
            assert_eq!(packages(dotted, meant), expected, "{dotted}");
        }
    }
}
