//! SCL0502: an end with a gate that its component does not have.

use super::draft::Draft;
use super::unknown_component::swap;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::Spanned;
use crate::suggest::{MOST, nearest};
use scl_text::list::shortened;

/// SCL0502.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0502",
    severity: Severity::Error,
    title: "unknown gate",
    explanation: "The component exists, but has no gate of this name. The message lists its gates, and suggests those \
                  with a similar name that would fit the other end.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
   - name: controller
     gates:
       - sensor: sub
 connections:
-  - [sensor.measurement, controller.sensor]
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
    let headline = format!("component `{component}` has no gate `{gate}`");
    if let Some(swapped) = draft.gate(gate, component) {
        draft.gates[swapped].named = true;
        return problems.push(swap(draft, headline, text.span, [gate, component]));
    }
    // The gate may be one of those that could not be read.
    if draft.declarations(component).any(|twin| twin.gates_unread) {
        return;
    }
    let may_search = draft.may_search();
    let meant = if may_search { meant(draft, link, end, component, gate) } else { Vec::new() };
    let mut found = report(draft, text, headline, gate, &meant);
    // No name is similar: suggest the gate if only one fits and is unconnected, and do not report that one as well.
    let left = if may_search && meant.is_empty() { only_left(draft, link, end, component) } else { None };
    if let Some(left) = left {
        let place = draft.part(text.span, gate, true);
        let name = &draft.gates[left].model.name.value;
        let help = format!("{} fits and is not connected yet", draft.name_and_kind(left));
        found = found.suggest(help, [Edit::new(place, name)]);
    }
    problems.push(if may_search { found.note(known(draft, component)) } else { found });
    for gate in meant.into_iter().chain(left) {
        draft.gates[gate].named = true;
    }
}

/// Similar gates of the component that would fit the other end; of equally similar ones those that are unconnected.
fn meant(draft: &Draft<'_>, link: usize, end: usize, component: &str, gate: &str) -> Vec<usize> {
    let fitting = draft.gates_of(component).filter(|at| draft.fits([link, end], *at));
    let candidates = fitting.map(|at| draft.gates[at].model.name.value.as_str());
    let near: Vec<usize> =
        nearest(gate, candidates).into_iter().filter_map(|name| draft.gate(component, name)).collect();
    let open: Vec<usize> = near.iter().copied().filter(|at| !draft.gates[*at].named).collect();
    let best = if open.is_empty() { near } else { open };
    best.into_iter().take(MOST).collect()
}

/// The gate that fits and has no connection, if there is exactly one.
fn only_left(draft: &Draft<'_>, link: usize, end: usize, component: &str) -> Option<usize> {
    draft.links[link].ends[1 - end]?;
    let mut open = draft.gates_of(component).filter(|at| !draft.gates[*at].named && draft.fits([link, end], *at));
    open.next().filter(|_| open.next().is_none())
}

fn report(draft: &Draft<'_>, text: &Spanned<String>, headline: String, gate: &str, meant: &[usize]) -> Diagnostic {
    let place = draft.part(text.span, gate, true);
    let names: Vec<&str> = meant.iter().map(|&at| draft.gates[at].model.name.value.as_str()).collect();
    let found = RULE.at(headline, place, "unknown gate").about(&*text.value);
    let mut found = found.choose(("did you mean ", "?"), names.iter().map(|name| (*name, Edit::new(place, *name))));
    let [only] = meant else { return found };
    let only = &draft.gates[*only];
    // A gate that nothing is connected to, and that looks like this one, is certainly the one meant.
    if only.named || draft.sources.snippet(place) != gate {
        found.doubt();
    }
    found.label(only.model.name.span, "a similar gate is declared here")
}

fn known(draft: &Draft<'_>, component: &str) -> String {
    let all: Vec<String> = draft.gates_of(component).map(|at| draft.name_and_kind(at)).collect();
    match all.is_empty() {
        true => format!("`{component}` has no gates"),
        false => format!("gates of `{component}`: {}", shortened(&all)),
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{example, rule_example};
    use expect_test::expect;

    #[test]
    fn unknown_gate() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0502] component `sensor` has no gate `measurement`
             --> topology.yaml:9:13
              |
            4 |       - measurements: pub
              |         ------------ a similar gate is declared here
            ...
            9 |   - [sensor.measurement, controller.sensor]
              |             ^^^^^^^^^^^ unknown gate
              |
              = help: did you mean `measurements`?
              = note: gates of `sensor`: `measurements` (pub)
        "#]],
        );
    }

    #[test]
    fn only_gates_that_fit_the_other_end_are_offered() {
        let yaml = "
components:
  - name: ui
    gates:
      - ask: req
  - name: pilot
    gates:
      - orders: rep
      - border: pub
connections:
  - [ui.ask, pilot.order]
";
        example(
            "SCL0502",
            yaml.trim_start(),
            expect![[r#"
            error: [SCL0502] component `pilot` has no gate `order`
              --> topology.yaml:10:20
               |
             7 |       - orders: rep
               |         ------ a similar gate is declared here
            ...
            10 |   - [ui.ask, pilot.order]
               |                    ^^^^^ unknown gate
               |
               = help: did you mean `orders`?
               = note: gates of `pilot`: `orders` (rep), `border` (pub)
        "#]],
        );
    }
}
