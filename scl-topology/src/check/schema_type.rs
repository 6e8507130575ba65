//! SCL0405: a type that none of the `schemas` declares. Without schemas the compiler looks types up instead.

use super::draft::Draft;
use super::{Facts, SchemaMessages};
use crate::diagnostic::Severity;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rule::{Examples, Rule};
use crate::suggest::{same_parts, similar};
use crate::topology::{Payload, TypeName};
use crate::wording::{either, listed};
use std::collections::HashSet;

/// SCL0405.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0405",
    severity: Severity::Error,
    title: "unknown message type",
    explanation: "The file names `schemas`, and none of them declares this message. It is mostly misspelt, or its \
                  package is missing before the dot. Without `schemas` the name is looked up by rustc instead.",
    examples: Examples::Topology {
        bad: "schemas: [uav.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: uav.Mesurement}
",
        good: "schemas: [uav.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: uav.Measurement}
",
    },
};

pub(super) fn check(draft: &mut Draft<'_>, facts: &Facts, problems: &mut Diagnostics) {
    let Some(schemas) = &facts.messages else { return };
    let known: HashSet<&str> = schemas.iter().flat_map(|schema| schema.names.iter()).map(String::as_str).collect();
    for at in 0..draft.gates.len() {
        let unknown: Vec<TypeName> = types(draft.gates[at].payload.as_ref())
            .into_iter()
            .filter(|name| !known.contains(name.dotted()))
            .cloned()
            .collect();
        for name in &unknown {
            problems.push(report(draft, schemas, &known, name));
            draft.gates[at].payload = None;
        }
    }
}

fn types(payload: Option<&Payload>) -> Vec<&TypeName> {
    match payload {
        Some(Payload::Message(name)) => vec![name],
        Some(Payload::Exchange { request, reply }) => vec![request, reply],
        Some(Payload::Bytes) | None => Vec::new(),
    }
}

fn report(draft: &Draft<'_>, schemas: &[SchemaMessages], known: &HashSet<&str>, name: &TypeName) -> Diagnostic {
    let mut all: Vec<&str> = known.iter().copied().collect();
    all.sort_unstable();
    let mut meant = same_parts(name.dotted(), all.iter().copied());
    if meant.is_empty() {
        meant = similar(name.dotted(), all.iter().copied());
    }
    let headline = format!("unknown message type `{}`", name.dotted());
    let mut found = RULE.at(headline, name.span(), "not in the schemas");
    if let [only] = meant.as_slice() {
        let declares = |schema: &SchemaMessages| schema.names.iter().any(|other| other == only);
        let place = schemas.iter().position(declares).and_then(|at| draft.model.schemas.get(at));
        if let Some(place) = place {
            found = found.label(place.span, format!("declares `{only}`"));
        }
    }
    if !meant.is_empty() {
        found = found.help(format!("did you mean {}?", either(&meant)));
    }
    if all.is_empty() {
        return found.note("the `schemas` declare no message types");
    }
    found.note(format!("message types in `schemas`: {}", listed(all)))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{example_with, rule_example_with};
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
              = note: message types in `schemas`: `uav.Measurement`
        "#]],
        );
    }
}
