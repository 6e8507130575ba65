//! SCL0501: an end of a component that does not exist. SCL0504: its two names are swapped.

use super::connection_end::parts;
use super::draft::Draft;
use crate::diagnostic::Severity;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rule::{Examples, Rule};
use crate::suggest::similar;
use crate::wording::{either, listed};

/// SCL0501.
pub const UNKNOWN: Rule = Rule {
    code: "SCL0501",
    severity: Severity::Error,
    title: "unknown component",
    explanation: "An end of a connection names a component that is not declared, mostly because it is misspelt. The \
                  message offers the declared ones that resemble it and have such a gate.",
    examples: Examples::Topology {
        bad: "components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controler.sensor]
",
        good: "components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
",
    },
};

/// SCL0504.
pub(crate) const SWAPPED: Rule = Rule {
    code: "SCL0504",
    severity: Severity::Error,
    title: "component and gate swapped",
    explanation: "Component and gate stand in the wrong order. Written the other way round, they name a gate that \
                  exists.",
    examples: Examples::Topology {
        bad: "components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [measurements.sensor, controller.sensor]
",
        good: "components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
",
    },
};

pub(super) fn check(draft: &mut Draft<'_>, link: usize, end: usize, problems: &mut Diagnostics) {
    let text = &draft.links[link].model.ends[end];
    let Some((component, gate)) = parts(&text.value) else { return };
    let headline = format!("unknown component `{component}`");
    if let Some(swapped) = draft.gate(gate, component) {
        draft.gates[swapped].named = true;
        return problems.push(swap(headline, text.span, gate, component));
    }
    if draft.model.components_unread {
        return;
    }
    let place = draft.part(text.span, component, false);
    let mut found = UNKNOWN.at(headline, place, "no component has this name");
    let meant = if draft.may_search() { meant(draft, component, gate) } else { Vec::new() };
    for at in meant.iter().filter_map(|name| draft.component(name)) {
        found = found.label(draft.components[at].model.name.span, "a similar name is declared here");
    }
    for name in &meant {
        if let Some(gate) = draft.gate(name, gate) {
            draft.gates[gate].named = true;
        }
    }
    if !meant.is_empty() {
        found = found.help(format!("did you mean {}?", either(&meant)));
    }
    problems.push(found.note(declared(draft)));
}

/// The report of an end whose two names are in the wrong order.
pub(super) fn swap(headline: String, span: crate::source::Span, component: &str, gate: &str) -> Diagnostic {
    SWAPPED.at(headline, span, "component and gate are swapped").help(format!("write `{component}.{gate}`"))
}

/// Similar components that have the gate; without such, those that have a similar gate.
fn meant(draft: &Draft<'_>, component: &str, gate: &str) -> Vec<String> {
    let near = similar(component, draft.component_names.iter().copied());
    let has_similar = |other: &str| {
        let gates = draft.gates_of(other).map(|at| draft.gates[at].model.name.value.as_str());
        !similar(gate, gates).is_empty() || draft.declarations(other).any(|twin| twin.gates_unread)
    };
    let owners: Vec<&str> = near.iter().copied().filter(|other| draft.gate(other, gate).is_some()).collect();
    let best = match owners.is_empty() {
        true => near.into_iter().filter(|other| has_similar(other)).collect(),
        false => owners,
    };
    best.into_iter().map(str::to_owned).collect()
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
