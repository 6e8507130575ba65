//! SCL0411: a type of an unknown package that is probably a message of a schema: of one that the file does not name,
//! or in another package.

use super::Facts;
use super::draft::Draft;
use super::schema_names::{Known, Unknown};
use super::schema_package::{by_mistake, retyped, with_places, wrong_package};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity, appended};
use crate::topology::{Payload, TypeName};
use std::collections::{BTreeMap, HashMap, HashSet};

/// SCL0411.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0411",
    severity: Severity::Warning,
    title: "type that may be a message of a schema",
    explanation: "The first part of this type is not a package of the `schemas`, so it is a Rust path, which rustc looks \
                  up where the macro is called. But a schema file that `schemas` does not name declares it, or the \
                  schemas have messages of these names in another package, which no gate carries. Add the file, or \
                  correct the package. If a Rust type is meant, allow this warning, or write the path from the root \
                  of the crate: `crate.drone.Measurement`.",
    example: " schemas: [uav.proto]
 components:
   - name: sensor
     gates:
-      - measurements: {pub: drone.Measurement}
+      - measurements: {pub: uav.Measurement}
",
};

/// Words that begin a path that can only be one of Rust.
const RUST: [&str; 6] = ["crate", "self", "super", "std", "core", "alloc"];

/// The usual first parts of packages in Java.
const DOMAINS: [&str; 10] = ["com", "org", "net", "io", "edu", "gov", "dev", "de", "fr", "uk"];

pub(super) fn check(draft: &Draft<'_>, facts: &Facts, problems: &mut Diagnostics) {
    let Some(schemas) = &facts.messages else { return };
    let foreign: Vec<(usize, usize, &TypeName)> = foreign(draft).collect();
    if foreign.is_empty() {
        return;
    }
    let (known, used) = (Known::of(schemas, []), draft.messages_used());
    let unlisted: HashMap<&str, &str> = facts
        .unlisted
        .iter()
        .flat_map(|schema| schema.names.iter().map(|name| (name.as_str(), schema.path.as_str())))
        .collect();
    let mut of_file: BTreeMap<&str, Vec<Unknown<'_>>> = BTreeMap::new();
    let mut of_package = Vec::new();
    for (gate, part, name) in foreign {
        let unknown = |meant| Unknown { gate, part, name: name.clone(), meant };
        if let Some(path) = unlisted.get(name.dotted()) {
            of_file.entry(path).or_default().push(unknown(Vec::new()));
        } else {
            let is_meant = |meant: &&str| is_in_domain(name.dotted(), meant) || !used.contains(meant);
            let meant = known.in_other_package(name.dotted()).filter(is_meant);
            of_package.extend(meant.map(|meant| unknown(vec![meant])));
        }
    }
    problems.extend(of_file.into_iter().filter_map(|(path, group)| not_listed(draft, path, &group)));
    let packages = used.iter().filter_map(|name| name.rsplit_once('.'));
    let packages: HashSet<&str> = packages.map(|(package, _)| package).collect();
    problems.extend(by_mistake(of_package).into_iter().filter_map(|group| {
        let found =
            wrong_package(&RULE, draft, &group, false).or_else(|| in_other_package(draft, &group, &packages))?;
        Some(found.note("a type that the `schemas` do not declare is a path in the program's Rust code"))
    }));
}

/// The types with a package that no schema declares, each with its gate and its number there.
fn foreign<'d>(draft: &'d Draft<'_>) -> impl Iterator<Item = (usize, usize, &'d TypeName)> {
    let is_foreign = |name: &TypeName| {
        let first = name.dotted().split_once('.').map(|(first, _)| first);
        !name.in_schemas() && first.is_some_and(|first| !RUST.contains(&first))
    };
    draft.gates.iter().enumerate().flat_map(move |(gate, of)| {
        let types = of.payload.as_ref().map(Payload::types).unwrap_or_default().into_iter().enumerate();
        types.filter(move |(_, name)| is_foreign(name)).map(move |(part, name)| (gate, part, name))
    })
}

/// Whether a type is a message below the name of a domain, as its package is called in Java: `com.example.nav.Fix`.
fn is_in_domain(written: &str, meant: &str) -> bool {
    let domain = written.strip_suffix(meant).and_then(|domain| domain.strip_suffix('.'));
    domain.and_then(|domain| domain.split('.').next()).is_some_and(|top| DOMAINS.contains(&top))
}

/// One type with the name of a message. If gates carry other messages of the package, that may be by chance.
fn in_other_package(draft: &Draft<'_>, group: &[Unknown<'_>], used: &HashSet<&str>) -> Option<Diagnostic> {
    let first = group.first()?;
    let meant = first.meant.first()?;
    let is_in_domain = is_in_domain(first.name.dotted(), meant);
    if !is_in_domain && meant.rsplit_once('.').is_some_and(|(package, _)| used.contains(package)) {
        return None;
    }
    let headline = format!("the `schemas` declare `{meant}`, but not `{}`", first.name.dotted());
    let found = with_places(RULE.at(headline, first.name.span(), "not in the `schemas`"), group);
    let text = match is_in_domain {
        true => format!("write `{meant}`: the package is that of the `.proto` file, not of another language"),
        false => format!("write `{meant}`, which no gate carries yet"),
    };
    Some(found.suggest(text, retyped(draft, group, meant)))
}

fn not_listed(draft: &Draft<'_>, path: &str, group: &[Unknown<'_>]) -> Option<Diagnostic> {
    let first = group.first()?;
    let dotted = first.name.dotted();
    let headline = format!("`{dotted}` is declared by `{path}`, which is not one of the `schemas`");
    let found = with_places(RULE.at(headline, first.name.span(), "not in the `schemas`"), group);
    let last = draft.model.schemas.last()?;
    Some(match appended(draft.sources.file(last.span.file), "schemas", &draft.model.schemas, path) {
        Some((text, edit)) => found.suggest(text, [edit]),
        None => found.help(format!("add `{path}` to `schemas`")),
    })
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice_with, rule_example_with};
    use expect_test::expect;

    #[test]
    fn type_that_may_be_a_message_of_a_schema() {
        rule_example_with(
            &RULE,
            Some(&["uav.Measurement"]),
            expect![[r#"
            warning: [SCL0411] the `schemas` declare `uav.Measurement`, but not `drone.Measurement`
             --> topology.yaml:5:29
              |
            5 |       - measurements: {pub: drone.Measurement}
              |                             ^^^^^^^^^^^^^^^^^ not in the `schemas`
              |
              = help: write `uav.Measurement`, which no gate carries yet
              = note: a type that the `schemas` do not declare is a path in the program's Rust code
        "#]],
        );
    }

    #[test]
    fn a_rust_type_that_no_unused_message_resembles_is_one() {
        let told = |types: [&str; 2]| {
            let gates: String = types
                .iter()
                .map(|name| format!("      - {}: {{pub: {name}}}\n", name.to_lowercase().replace('.', "_")))
                .collect();
            let yaml = format!("schemas: [uav.proto]\ncomponents:\n  - name: a\n    gates:\n{gates}");
            format!("{types:?}: {}\n", advice_with(&RULE, &yaml, &["uav.Measurement", "uav.Status"]))
        };
        let cases = [
            ["drone.Measurement", "drone.Status"],
            ["drone.Measurement", "camera.Image"],
            ["drone.Measurement", "uav.Measurement"],
            ["drone.Measurement", "uav.Status"],
            ["crate.Measurement", "crate.drone.Status"],
            ["drone.Measurement", "copter.Status"],
            ["com.example.uav.Measurement", "uav.Status"],
            ["messages.uav.Measurement", "uav.Status"],
        ];
        expect![[r#"
            ["drone.Measurement", "drone.Status"]: the `schemas` declare these types in the package `uav`, not `drone` [write the other package: `uav.Measurement`, `uav.Status`]
            ["drone.Measurement", "camera.Image"]: the `schemas` declare `uav.Measurement`, but not `drone.Measurement` [write `uav.Measurement`, which no gate carries yet]
            ["drone.Measurement", "uav.Measurement"]: 
            ["drone.Measurement", "uav.Status"]: 
            ["crate.Measurement", "crate.drone.Status"]: 
            ["drone.Measurement", "copter.Status"]: the `schemas` declare `uav.Measurement`, but not `drone.Measurement` [write `uav.Measurement`, which no gate carries yet]; the `schemas` declare `uav.Status`, but not `copter.Status` [write `uav.Status`, which no gate carries yet]
            ["com.example.uav.Measurement", "uav.Status"]: the `schemas` declare `uav.Measurement`, but not `com.example.uav.Measurement` [write `uav.Measurement`: the package is that of the `.proto` file, not of another language]
            ["messages.uav.Measurement", "uav.Status"]: 
        "#]].assert_eq(&cases.map(told).concat());
    }
}
