//! SCL0405: a type of the schemas that none of them declares. Decides which types are those of the schemas.
//!
//! A type whose first part is a package of the schemas is one of theirs. Any other is a Rust path, which rustc looks up
//! where the macro is called, unless it is nearly the name of a message or a single word in lower case.

use super::Facts;
use super::draft::Draft;
use super::rust_path::is_rust;
use super::schema_names::{Known, Unknown};
use super::unknown_type::Report;
use crate::diagnostic::{Diagnostics, Rule, Severity};

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
    let known = Known::of(schemas, draft.model.schemas.iter().map(|schema| schema.value.as_str()));
    let mut unknown: Vec<Unknown<'_>> = Vec::new();
    for gate in 0..draft.gates.len() {
        let Some(mut payload) = draft.gates[gate].payload.take() else { continue };
        let before = unknown.len();
        for (part, name) in payload.types_mut().into_iter().enumerate() {
            if known.all.contains_key(name.dotted()) {
                name.in_schemas = true;
                continue;
            }
            let meant = known.nearest(name.dotted(), || draft.may_search());
            let is_lower_word =
                || !name.dotted().contains('.') && name.dotted().starts_with(|first: char| first.is_lowercase());
            if known.has_root(name.dotted()) || !meant.is_empty() || is_lower_word() && !is_rust(name.dotted()) {
                unknown.push(Unknown { gate, part, name: name.clone(), meant });
            }
        }
        draft.gates[gate].payload = if unknown.len() > before { None } else { Some(payload) };
    }
    if !unknown.is_empty() {
        problems.extend(Report::new(&RULE, draft, &known).of(unknown));
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
            ("google.protobuf.Timestamp", "a gate carries a message, which may have a field of this type"),
        ];
        for (message, expected) in cases {
            assert_eq!(told(message), expected, "{message}");
        }
    }
}
