//! SCL0501: an end of a component that does not exist. SCL0504: its two names are swapped.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::Span;
use crate::suggest::{MOST, nearest, similar};
use scl_text::list::listed;

/// SCL0501.
pub const UNKNOWN: Rule = Rule {
    code: "SCL0501",
    severity: Severity::Error,
    title: "unknown component",
    explanation: "An end of a connection names a component that is not declared; the name is probably misspelt. The \
                  message suggests components with a similar name that have such a gate.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
   - name: controller
     gates:
       - sensor: sub
 connections:
-  - [sensor.measurements, controler.sensor]
+  - [sensor.measurements, controller.sensor]
",
};

/// SCL0504.
pub(crate) const SWAPPED: Rule = Rule {
    code: "SCL0504",
    severity: Severity::Error,
    title: "component and gate swapped",
    explanation: "Component and gate are in the wrong order. Written the other way round, they name a gate that \
                  exists.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
   - name: controller
     gates:
       - sensor: sub
 connections:
-  - [measurements.sensor, controller.sensor]
+  - [sensor.measurements, controller.sensor]
",
};

pub(super) fn check(
    draft: &mut Draft<'_>,
    [link, end]: [usize; 2],
    [component, gate]: [&str; 2],
    problems: &mut Diagnostics,
) {
    let text = &draft.links[link].model.ends[end];
    let headline = format!("unknown component `{component}`");
    if let Some(swapped) = draft.gate(gate, component) {
        draft.gates[swapped].named = true;
        return problems.push(swap(draft, headline, text.span, [gate, component]));
    }
    if draft.model.components_unread {
        return;
    }
    let place = draft.part(text.span, component, false);
    let meant = if draft.may_search() { meant(draft, link, end, [component, gate]) } else { Vec::new() };
    let declarations = meant.iter().filter_map(|name| draft.component(name));
    let similar = declarations.map(|at| (draft.components[at].model.name.span, "a similar name is declared here"));
    let found = UNKNOWN.at(headline, place, "no component has this name").about(component).labels(similar);
    let is_open = |name: &String| draft.gate(name, gate).is_some_and(|gate| !draft.gates[gate].named);
    let open_before = meant.iter().all(is_open);
    for name in &meant {
        if let Some(gate) = draft.gate(name, gate) {
            draft.gates[gate].named = true;
        }
    }
    let ways = meant.iter().map(|name| (name.as_str(), Edit::new(place, name)));
    let mut found = found.choose(("did you mean ", "?"), ways);
    // If its gate is connected to nothing, it is certainly the one meant.
    if !(open_before && draft.sources.snippet(place) == component) {
        found.doubt();
    }
    problems.push(found.note(declared(draft)));
}

/// The report of an end whose two names are in the wrong order.
pub(super) fn swap(draft: &Draft<'_>, headline: String, span: Span, [component, gate]: [&str; 2]) -> Diagnostic {
    let meant = format!("{component}.{gate}");
    SWAPPED
        .at(headline, span, "component and gate are swapped")
        .propose(format!("write `{meant}`"), [Edit::new(span, draft.sources.quoted_as(span, &meant))])
}

/// Returns similar components that have the gate, or else those that have a similar gate. Of equally similar ones,
/// prefers those whose gate fits the other end and is unconnected.
fn meant(draft: &Draft<'_>, link: usize, end: usize, [component, gate]: [&str; 2]) -> Vec<String> {
    let near = nearest(component, draft.component_names.iter().copied());
    let has_similar = |other: &str| {
        let gates = draft.gates_of(other).map(|at| draft.gates[at].model.name.value.as_str());
        !similar(gate, gates).is_empty() || draft.declarations(other).any(|twin| twin.gates_unread)
    };
    let mut best: Vec<&str> = near.iter().copied().filter(|other| draft.gate(other, gate).is_some()).collect();
    if best.is_empty() {
        best = near.into_iter().filter(|other| has_similar(other)).collect();
    }
    keep_if_any(&mut best, |name| draft.gate(name, gate).is_none_or(|gate| draft.fits([link, end], gate)));
    keep_if_any(&mut best, |name| draft.gate(name, gate).is_none_or(|gate| !draft.gates[gate].named));
    best.into_iter().take(MOST).map(str::to_owned).collect()
}

/// Keeps only the names that pass, unless none does.
fn keep_if_any(names: &mut Vec<&str>, passes: impl Fn(&str) -> bool) {
    if names.iter().any(|name| passes(name)) {
        names.retain(|name| passes(name));
    }
}

fn declared(draft: &Draft<'_>) -> String {
    match draft.component_names.as_slice() {
        [] => "no components are declared".to_owned(),
        names => format!("declared components: {}", listed(names)),
    }
}

#[cfg(test)]
mod tests {
    use super::{SWAPPED, UNKNOWN};
    use crate::check::testing::{example, rule_example};
    use expect_test::expect;

    #[test]
    fn unknown_component() {
        rule_example(
            &UNKNOWN,
            expect![[r#"
            error: [SCL0501] unknown component `controler`
             --> topology.yaml:9:27
              |
            5 |   - name: controller
              |           ---------- a similar name is declared here
            ...
            9 |   - [sensor.measurements, controler.sensor]
              |                           ^^^^^^^^^ no component has this name
              |
              = help: did you mean `controller`?
              = note: declared components: `controller`, `sensor`
        "#]],
        );
    }

    #[test]
    fn component_and_gate_swapped() {
        rule_example(
            &SWAPPED,
            expect![[r#"
            error: [SCL0504] unknown component `measurements`
             --> topology.yaml:9:6
              |
            9 |   - [measurements.sensor, controller.sensor]
              |      ^^^^^^^^^^^^^^^^^^^ component and gate are swapped
              |
              = help: write `sensor.measurements`
        "#]],
        );
    }

    #[test]
    fn a_similar_component_without_the_gate_is_not_offered() {
        let yaml = "
components:
  - name: aircomm_swarm
    gates:
      - out: pub
  - name: pilot
    gates:
      - orders: sub
connections:
  - [aircomm.report, pilot.orders]
";
        example(
            "SCL0501",
            yaml.trim_start(),
            expect![[r#"
            error: [SCL0501] unknown component `aircomm`
             --> topology.yaml:9:6
              |
            9 |   - [aircomm.report, pilot.orders]
              |      ^^^^^^^ no component has this name
              |
              = note: declared components: `aircomm_swarm`, `pilot`
        "#]],
        );
    }
}
