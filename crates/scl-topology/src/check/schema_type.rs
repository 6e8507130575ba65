//! SCL0405: a type of the schemas that none of them declares. Decides which types are those of the schemas.
//!
//! A type whose first part is a package of the schemas is one of theirs. Any other is a Rust path, which rustc looks up
//! where the macro is called, unless it is nearly the name of a message or a single word in lower case.

use super::draft::Draft;
use super::rust_path::{is_rust, is_scalar};
use super::{Facts, SchemaMessages};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::suggest::{same_parts, similar};
use crate::topology::TypeName;
use scl_text::list::listed;
use scl_text::suggest::bare;
use std::collections::{BTreeSet, HashMap};

/// Maximum number of names that a message suggests.
const MOST: usize = 3;

/// SCL0405.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0405",
    severity: Severity::Error,
    title: "unknown message type",
    explanation: "The first part of this type is a package of the `schemas`, or almost one, but no schema declares \
                  such a message. The type is probably misspelt, or lacks its package. If the first part is not a \
                  package, the type is a Rust path, which rustc looks up where the macro is called; a single word in \
                  lower case is neither.",
    example: " schemas: [uav.proto]
 components:
   - name: sensor
     gates:
-      - measurements: {pub: uav.Mesurement}
+      - measurements: {pub: uav.Measurement}
",
};

pub(super) fn check(draft: &mut Draft<'_>, facts: &Facts, problems: &mut Diagnostics) {
    let Some(schemas) = &facts.messages else { return };
    let known = Known::of(schemas);
    for at in 0..draft.gates.len() {
        let Some(mut payload) = draft.gates[at].payload.take() else { continue };
        let mut unknown = false;
        for name in payload.types_mut() {
            if known.all.contains(name.dotted()) {
                name.in_schemas = true;
                continue;
            }
            let meant = known.nearest(name.dotted(), || draft.may_search());
            let is_lower_word =
                || !name.dotted().contains('.') && name.dotted().starts_with(|first: char| first.is_lowercase());
            if known.has_root(name.dotted()) || !meant.is_empty() || is_lower_word() && !is_rust(name.dotted()) {
                problems.push(report(draft, schemas, &known, name, &meant));
                unknown = true;
            }
        }
        draft.gates[at].payload = if unknown { None } else { Some(payload) };
    }
}

/// The messages of all schemas.
struct Known<'s> {
    all: BTreeSet<&'s str>,
    /// The first part of every name: a package, or a message without one.
    roots: BTreeSet<&'s str>,
    /// The names by their last part.
    by_last: HashMap<&'s str, Vec<&'s str>>,
    /// The names by themselves and by their last part, both [`bare`].
    by_bare: HashMap<String, Vec<&'s str>>,
}

impl<'s> Known<'s> {
    fn of(schemas: &'s [SchemaMessages]) -> Self {
        let all: BTreeSet<&str> = schemas.iter().flat_map(|schema| schema.names.iter()).map(String::as_str).collect();
        let packages = schemas.iter().flat_map(|schema| schema.packages.iter()).map(String::as_str);
        let packages = packages.filter(|package| !package.is_empty());
        let roots = all.iter().copied().chain(packages).map(root).chain(["google"]).collect();
        let mut by_last: HashMap<&str, Vec<&str>> = HashMap::new();
        let mut by_bare: HashMap<String, Vec<&str>> = HashMap::new();
        for name in &all {
            let last = name.rsplit('.').next().unwrap_or_default();
            by_last.entry(last).or_default().push(name);
            by_bare.entry(bare(last)).or_default().push(name);
            if last != *name {
                by_bare.entry(bare(name)).or_default().push(name);
            }
        }
        Self { all, roots, by_last, by_bare }
    }

    /// Returns true if the type can only be one of the schemas, because its first part belongs to them.
    fn has_root(&self, dotted: &str) -> bool {
        self.roots.contains(root(dotted))
    }

    /// The messages that an unknown type may mean. For a type outside of the schemas' packages, only those whose
    /// package is misspelt or missing: any other is a Rust path.
    ///
    /// Calls `may_search` before a search that takes long in a file with very many types.
    fn nearest(&self, dotted: &str, mut may_search: impl FnMut() -> bool) -> Vec<&'s str> {
        let all = || self.all.iter().copied();
        if self.has_root(dotted) {
            return match may_search() {
                true => some(same_parts(dotted, all())).unwrap_or_else(|| similar(dotted, all())),
                false => Vec::new(),
            };
        }
        let Some((first, rest)) = dotted.split_once('.') else { return self.without_package(dotted, may_search) };
        // `rover_msgs.Event`, `rover_pb2.Event`: the package with the name of a tool's module.
        let extended = first.split('_').filter_map(|word| self.all.get(format!("{word}.{rest}").as_str()).copied());
        if let Some(found) = some(extended.collect()) {
            return found;
        }
        let swapped: Vec<&str> = dotted.rsplit('.').collect();
        if let Some(&name) = self.all.get(swapped.join(".").as_str()) {
            return vec![name];
        }
        let roots = similar(first, self.roots.iter().copied());
        let misspelt = roots.iter().filter_map(|root| self.all.get(format!("{root}.{rest}").as_str()).copied());
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

fn report(
    draft: &Draft<'_>,
    schemas: &[SchemaMessages],
    known: &Known<'_>,
    name: &TypeName,
    meant: &[&str],
) -> Diagnostic {
    let headline = format!("unknown message type `{}`", name.dotted());
    let declared = if let [only] = meant { Some(*only) } else { None }.and_then(|only| {
        let declares = |schema: &SchemaMessages| schema.names.iter().any(|other| other == only);
        let place = schemas.iter().position(declares).and_then(|at| draft.model.schemas.get(at))?;
        Some((place.span, format!("declares `{only}`")))
    });
    let is_path = !known.has_root(name.dotted()) && !is_scalar(name.dotted());
    let path = is_path.then(|| format!("a Rust type of your own has a path: `crate.{}`", name.dotted()));
    let found = RULE
        .at(headline, name.span(), "not in the schemas")
        .about(name.dotted())
        .labels(declared)
        .did_you_mean(name.dotted(), meant)
        .helps(path);
    match known.all.is_empty() {
        true => found.note("the `schemas` declare no message types"),
        false => found.note(format!("message types in `schemas`: {}", listed(&known.all))),
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{example_with, problems, rule_example_with};
    use expect_test::expect;

    #[test]
    fn unknown_message_type() {
        rule_example_with(
            &RULE,
            Some(&["uav.Command", "uav.Measurement", "uav.Status"]),
            expect![[r#"
            error: [SCL0405] unknown message type `uav.Mesurement`
             --> topology.yaml:5:29
              |
            1 | schemas: [uav.proto]
              |           --------- declares `uav.Measurement`
            ...
            5 |       - measurements: {pub: uav.Mesurement}
              |                             ^^^^^^^^^^^^^^ not in the schemas
              |
              = help: did you mean `uav.Measurement`?
              = note: message types in `schemas`: `uav.Command`, `uav.Measurement`, `uav.Status`
        "#]],
        );
    }

    #[test]
    fn the_last_part_of_a_name_finds_its_package() {
        let yaml = "
schemas: [uav.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: Measurement}
";
        example_with(
            "SCL0405",
            yaml.trim_start(),
            Some(&["uav.Measurement"]),
            expect![[r#"
                error: [SCL0405] unknown message type `Measurement`
                 --> topology.yaml:5:29
                  |
                1 | schemas: [uav.proto]
                  |           --------- declares `uav.Measurement`
                ...
                5 |       - measurements: {pub: Measurement}
                  |                             ^^^^^^^^^^^ not in the schemas
                  |
                  = help: did you mean `uav.Measurement`?
                  = help: a Rust type of your own has a path: `crate.Measurement`
                  = note: message types in `schemas`: `uav.Measurement`
            "#]],
        );
    }

    /// What is said about types in a file whose schemas declare `uav.Measurement`, `uav.v1.Fix` and `Time`.
    #[test]
    fn types_outside_of_the_packages_are_rust_paths() {
        let told = |message: &str| {
            let yaml =
                format!("schemas: [uav.proto]\ncomponents:\n  - name: a\n    gates:\n      - x: {{pub: {message}}}\n");
            let (found, _) = problems(&yaml, Some(&["uav.Measurement", "uav.v1.Fix", "Time"]));
            let found = found.into_iter().find(|found| found.code() == RULE.code);
            found.map_or_else(
                || "Rust or known".to_owned(),
                |found| found.shown_helps().next().map_or_else(String::new, |help| help.text().into_owned()),
            )
        };
        let cases = [
            ("uav.Measurement", "Rust or known"),
            ("Time", "Rust or known"),
            ("camera.Image", "Rust or known"),
            ("camera.Measurement", "Rust or known"),
            ("Image", "Rust or known"),
            ("crate.uav.Other", "Rust or known"),
            ("uva.Image", "Rust or known"),
            ("uav.Image", ""),
            ("uav.v2.Fix", "did you mean `uav.v1.Fix`?"),
            ("uva.Measurement", "did you mean `uav.Measurement`?"),
            ("UAV.Mesurement", "did you mean `uav.Measurement`?"),
            ("Measurement", "did you mean `uav.Measurement`?"),
            ("Measurement.uav", "did you mean `uav.Measurement`?"),
            ("Tmie", "did you mean `Time`?"),
            ("google.protobuf.Timestamp", ""),
        ];
        for (message, expected) in cases {
            assert_eq!(told(message), expected, "{message}");
        }
    }
}
