//! Mistakes that are made once and show at several places: an unknown type at several gates, and a gate of the wrong
//! kind that fits none of its connections. They are reported at the first place, with the other places as labels.

use super::{backpressure, codec_agreement, exchange_type, message_type, pair_kinds};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule};
use crate::source::Span;
use std::collections::HashMap;

/// Maximum number of further places that one problem shows.
const MOST: usize = 8;

pub(super) fn tell_once(problems: &mut Diagnostics) {
    let mut repeated: HashMap<(&Rule, String), Option<Vec<Diagnostic>>> = HashMap::new();
    problems.retain(|found| {
        let Some(subject) = found.subject.clone() else { return true };
        match repeated.entry((found.rule, subject)).or_default() {
            Some(others) => others.push(found.clone()),
            first => {
                *first = Some(Vec::new());
                return true;
            }
        }
        false
    });
    problems.retain(|found| {
        let others = found.subject.take().and_then(|subject| repeated.remove(&(found.rule, subject)).flatten());
        let others = others.unwrap_or_default();
        let places = others.iter().filter_map(|other| other.primary.as_ref());
        places.take(MOST).for_each(|label| found.add_label(label.span, "and here"));
        if !others.is_empty() {
            found.notes.push(format!("{} places have it", others.len() + 1));
            found.join_proposals(others);
        }
        true
    });
    gates_that_do_not_fit(problems);
}

/// The rules about two gates that do not fit each other; their labels show the two.
const PAIRS: [&Rule; 8] = [
    &pair_kinds::SAME_DIRECTION,
    &pair_kinds::OTHER_PATTERN,
    &backpressure::RULE,
    &message_type::RULE,
    &exchange_type::REQUESTS_DIFFER,
    &exchange_type::REPLIES_DIFFER,
    &exchange_type::SWAPPED_TYPES,
    &codec_agreement::RULE,
];

/// Merges the reports of connections that do not fit because of the same gate. The gate that most of them share is
/// taken to be at fault.
fn gates_that_do_not_fit(problems: &mut Diagnostics) {
    let mut counts: HashMap<(&Rule, Span), usize> = HashMap::new();
    problems.retain(|found| {
        if PAIRS.contains(&found.rule) {
            found.secondary.iter().for_each(|gate| *counts.entry((found.rule, gate.span)).or_default() += 1);
        }
        true
    });
    let at_fault = |found: &Diagnostic| {
        let gates = found.secondary.iter().map(|gate| (found.rule, gate.span));
        let shared = gates.filter(|gate| counts.get(gate).is_some_and(|count| *count > 1));
        shared.max_by_key(|gate| (counts.get(gate), gate.1.start)).filter(|_| PAIRS.contains(&found.rule))
    };
    // For each gate, the places of its other connections that do not fit.
    let mut told: HashMap<(&Rule, Span), Vec<Span>> = HashMap::new();
    problems.retain(|found| {
        let Some(gate) = at_fault(found) else { return true };
        let is_first = !told.contains_key(&gate);
        let others = told.entry(gate).or_default();
        others.extend(found.primary.as_ref().filter(|_| !is_first).map(|label| label.span));
        is_first
    });
    problems.retain(|found| {
        let others = at_fault(found).and_then(|gate| told.remove(&gate)).unwrap_or_default();
        others.iter().take(MOST).for_each(|place| found.add_label(*place, "nor does this one fit"));
        if !others.is_empty() {
            found.notes.push(format!("{} connections of the same gate do not fit", others.len() + 1));
        }
        true
    });
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn a_misspelt_declaration_is_one_mistake() {
        let yaml = "
components:
  - name: contoller
    gates:
      - a: sub
      - b: sub
  - name: sensor
    gates:
      - a: pub
      - b: pub
connections:
  - [sensor.a, controller.a]
  - [sensor.b, controller.b]
";
        example(
            "SCL0501",
            yaml.trim_start(),
            expect![[r#"
                error: [SCL0501] unknown component `controller`
                  --> topology.yaml:11:16
                   |
                 2 |   - name: contoller
                   |           --------- a similar name is declared here
                ...
                11 |   - [sensor.a, controller.a]
                   |                ^^^^^^^^^^ no component has this name
                12 |   - [sensor.b, controller.b]
                   |                ---------- and here
                   |
                   = help: rename `contoller` to `controller`, as the connections call it
                   = help: or write `contoller` in the connections
                   = note: declared components: `contoller`, `sensor`
                   = note: 2 connections name it
            "#]],
        );
    }
}
