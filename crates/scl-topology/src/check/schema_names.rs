//! The messages of all schemas, and those that an unknown type may mean.

use super::SchemaMessages;
use crate::suggest::{MOST, same_parts, similar};
use crate::topology::TypeName;
use scl_text::suggest::bare;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

/// The messages of all schemas.
pub(super) struct Known<'s> {
    /// The messages, with the number of the entry of `schemas` that declares each.
    pub(super) all: BTreeMap<&'s str, usize>,
    /// The enums by their names and by their last parts, with the messages that have a field of each.
    enums: HashMap<&'s str, &'s [String]>,
    /// The first part of every name: a package, or a message without one.
    roots: BTreeSet<&'s str>,
    /// The names by their last part.
    by_last: HashMap<&'s str, Vec<&'s str>>,
    /// The names by themselves and by their last part, both [`bare`].
    by_bare: HashMap<String, Vec<&'s str>>,
    /// The entries of `schemas` by the names of their files, without folder and ending.
    by_file: HashMap<&'s str, usize>,
}

impl<'s> Known<'s> {
    /// `files` are the entries of the file's `schemas`.
    pub(super) fn of(schemas: &'s [SchemaMessages], files: impl IntoIterator<Item = &'s str>) -> Self {
        let names = schemas.iter().enumerate().flat_map(|(at, schema)| schema.names.iter().map(move |name| (name, at)));
        let all: BTreeMap<&str, usize> = names.map(|(name, at)| (name.as_str(), at)).collect();
        let packages = schemas.iter().flat_map(|schema| schema.packages.iter()).map(String::as_str);
        let packages = packages.filter(|package| !package.is_empty());
        let enums = schemas.iter().flat_map(|schema| schema.enums.iter());
        let enums = enums.flat_map(|(name, users)| [name.as_str(), last(name)].map(|name| (name, users.as_slice())));
        let enums: HashMap<&str, &[String]> = enums.collect();
        let roots = all.keys().copied().chain(packages).map(root).chain(["google"]).collect();
        let mut by_last: HashMap<&str, Vec<&str>> = HashMap::new();
        let mut by_bare: HashMap<String, Vec<&str>> = HashMap::new();
        for name in all.keys() {
            let last = last(name);
            by_last.entry(last).or_default().push(name);
            by_bare.entry(bare(last)).or_default().push(name);
            if last != *name {
                by_bare.entry(bare(name)).or_default().push(name);
            }
        }
        let stems = files.into_iter().map(|file| Path::new(file).file_stem().and_then(|stem| stem.to_str()));
        let by_file = stems.enumerate().filter_map(|(at, stem)| Some((stem?, at))).collect();
        Self { all, enums, roots, by_last, by_bare, by_file }
    }

    fn message(&self, name: &str) -> Option<&'s str> {
        self.all.get_key_value(name).map(|(name, _)| *name)
    }

    /// The messages that have a field of this enum; `None` if there is no such enum.
    pub(super) fn users_of_enum(&self, dotted: &str) -> Option<&'s [String]> {
        self.enums.get(dotted).copied()
    }

    /// Returns true if the type can only be one of the schemas, because its first part belongs to them.
    pub(super) fn has_root(&self, dotted: &str) -> bool {
        self.roots.contains(root(dotted)) || self.enums.contains_key(dotted)
    }

    /// The only message that has the same last part as a type of another package.
    pub(super) fn in_other_package(&self, dotted: &str) -> Option<&'s str> {
        match self.by_last.get(last(dotted))?.as_slice() {
            [only] => Some(only),
            _ => None,
        }
    }

    /// The messages that an unknown type may mean. For a type outside of the schemas' packages, only those whose
    /// package is misspelt or missing: any other is a Rust path.
    ///
    /// Calls `may_search` before a search that takes long in a file with very many types.
    pub(super) fn nearest(&self, dotted: &str, mut may_search: impl FnMut() -> bool) -> Vec<&'s str> {
        let all = || self.all.keys().copied();
        if let Some(users) = self.users_of_enum(dotted) {
            return users.iter().map(String::as_str).take(MOST).collect();
        }
        if self.has_root(dotted) {
            return match may_search() {
                true => some(same_parts(dotted, all())).unwrap_or_else(|| similar(dotted, all())),
                false => Vec::new(),
            };
        }
        let Some((first, rest)) = dotted.split_once('.') else { return self.without_package(dotted, may_search) };
        // `rover_msgs.Event`, `rover_pb2.Event`: the package with the name of a tool's module.
        let extended = first.split('_').filter_map(|word| self.message(&format!("{word}.{rest}")));
        if let Some(found) = some(extended.collect()) {
            return found;
        }
        if let Some(found) = self.of_file(first, rest) {
            return vec![found];
        }
        let swapped: Vec<&str> = dotted.rsplit('.').collect();
        if let Some(name) = self.message(&swapped.join(".")) {
            return vec![name];
        }
        let roots = similar(first, self.roots.iter().copied());
        let misspelt = roots.iter().filter_map(|root| self.message(&format!("{root}.{rest}")));
        if let Some(found) = some(misspelt.collect()) {
            return found;
        }
        if roots.is_empty() || !may_search() {
            return Vec::new();
        }
        let fits = |name: &&str| {
            name.split_once('.')
                .is_some_and(|(root, other)| roots.contains(&root) && !similar(rest, [other]).is_empty())
        };
        all().filter(fits).take(MOST).collect()
    }

    /// `weather_station.Rain` means `met.Rain` if that is declared by `weather_station.proto`.
    fn of_file(&self, file: &str, rest: &str) -> Option<&'s str> {
        let only = self.in_other_package(rest).filter(|name| name.ends_with(rest))?;
        (self.by_file.get(file)? == self.all.get(only)?).then_some(only)
    }

    /// `Measurement`, `measurement`, `uavMeasurement` and `uav_measurement` mean `uav.Measurement`, and `Mesurement`
    /// that or a message that has no package.
    fn without_package(&self, name: &str, mut may_search: impl FnMut() -> bool) -> Vec<&'s str> {
        let found = |names: Option<&Vec<&'s str>>| names.map(|names| names.iter().copied().take(MOST).collect());
        let bare_name = bare(name);
        if let Some(names) = found(self.by_last.get(name)).or_else(|| found(self.by_bare.get(&bare_name))) {
            return names;
        }
        if !may_search() {
            return Vec::new();
        }
        let ends = similar(name, self.by_last.keys().copied());
        ends.iter().flat_map(|end| &self.by_last[end]).copied().take(MOST).collect()
    }
}

fn some(names: Vec<&str>) -> Option<Vec<&str>> {
    (!names.is_empty()).then_some(names)
}

fn root(dotted: &str) -> &str {
    dotted.split('.').next().unwrap_or_default()
}

fn last(dotted: &str) -> &str {
    dotted.rsplit('.').next().unwrap_or_default()
}

/// A type that no schema declares, and the messages that it may mean.
pub(super) struct Unknown<'s> {
    pub(super) gate: usize,
    /// Its number among the types of the gate.
    pub(super) part: usize,
    pub(super) name: TypeName,
    pub(super) meant: Vec<&'s str>,
}

#[cfg(test)]
mod tests {
    use super::Known;
    use crate::check::SchemaMessages;

    #[test]
    fn the_name_of_a_file_is_taken_for_its_package() {
        let schema = |names: &[&str]| SchemaMessages {
            names: names.iter().map(|&name| name.to_owned()).collect(),
            ..SchemaMessages::default()
        };
        let schemas = [schema(&["met.Rain", "met.Wind"]), schema(&["sea.Tide"])];
        let known = Known::of(&schemas, ["proto/weather_station.proto", "tides.proto"]);
        let cases: [(&str, &[&str]); 4] = [
            ("weather_station.Rain", &["met.Rain"]),
            ("weather_station.Tide", &[]),
            ("tides.Tide", &["sea.Tide"]),
            ("harbour.Rain", &[]),
        ];
        for (dotted, expected) in cases {
            assert_eq!(known.nearest(dotted, || true), expected, "{dotted}");
        }
    }
}
