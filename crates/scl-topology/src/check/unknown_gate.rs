//! SCL0502: an end with a gate that its component does not have.

use super::draft::Draft;
use super::end::{End, with_places};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::rust_name::gate_field;
use crate::source::Span;
use crate::spelling::is_well_formed;
use crate::suggest::{MOST, nearest};
use crate::topology::GateKind;
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

/// Maximum number of gates of other components that a search looks at.
const SEARCHED: usize = 32;

pub(super) fn check<'m>(
    draft: &mut Draft<'m>,
    [component, gate]: [&'m str; 2],
    ends: &[End],
    problems: &mut Diagnostics,
) {
    // The gate may be one of those that could not be read.
    if draft.declarations(component).any(|twin| twin.gates_unread) {
        return;
    }
    let of_end = |&[link, end]: &End| draft.part(draft.links[link].model.ends[end].span, gate, true);
    let places: Vec<Span> = ends.iter().map(of_end).collect();
    let found = RULE.at(format!("component `{component}` has no gate `{gate}`"), places[0], "unknown gate");
    if !draft.may_search() {
        return problems.push(with_places(found, &places));
    }
    let near = near(draft, ends, component, gate);
    if near.iter().any(|at| !is_well_formed(&draft.gates[*at].model.name.value)) {
        // The declaration is reported, and its name may become this one.
        return near.into_iter().for_each(|gate| draft.gates[gate].named = true);
    }
    let moved = if near.is_empty() { moved(draft, ends, component, gate) } else { Vec::new() };
    let left = if near.is_empty() && moved.is_empty() { only_left(draft, ends, component) } else { None };
    let found = match near.as_slice() {
        [only] => {
            let found = found.label(draft.gates[*only].model.name.span, "a similar gate is declared here");
            one_way(draft, found, gate, *only, &places)
        }
        _ => several_ways(draft, found, &near, &places),
    };
    let found = elsewhere(draft, found, &moved, ends);
    let found = match left {
        Some(left) => unconnected(draft, found, gate, left, &places),
        None => found,
    };
    let found = found.otherwise(declare(draft, [component, gate], ends[0]));
    problems.push(with_places(found.note(known(draft, component)), &places));
    for gate in near.into_iter().chain(moved).chain(left) {
        draft.gates[gate].named = true;
    }
}

/// Whether a gate fits the other ends of some ends.
fn fits(draft: &Draft<'_>, ends: &[End], gate: usize) -> bool {
    ends.iter().take(SEARCHED).all(|end| draft.fits(*end, gate))
}

/// Similar gates of the component that would fit the other end; of equally similar ones those that are unconnected.
fn near(draft: &Draft<'_>, ends: &[End], component: &str, gate: &str) -> Vec<usize> {
    let fitting: Vec<usize> = draft.gates_of(component).filter(|at| fits(draft, ends, *at)).collect();
    let name = |at: &usize| draft.gates[*at].model.name.value.as_str();
    let field = gate_field(gate);
    let mut names: Vec<&str> = fitting.iter().map(name).filter(|name| gate_field(name) == field).collect();
    if names.is_empty() {
        names = nearest(gate, fitting.iter().map(name));
    }
    let near: Vec<usize> = names.into_iter().filter_map(|name| draft.gate(component, name)).collect();
    let open: Vec<usize> = near.iter().copied().filter(|at| !draft.gates[*at].named).collect();
    let best = if open.is_empty() { near } else { open };
    best.into_iter().take(MOST).collect()
}

/// Gates of this name in other components, which fit and are unconnected; else those that are connected, too.
fn moved(draft: &Draft<'_>, ends: &[End], component: &str, gate: &str) -> Vec<usize> {
    let is_at_other_end = |at: usize| {
        ends.iter().any(|&[link, end]| {
            draft.links[link].ends[1 - end].is_none_or(|other| draft.component_name(other) == draft.component_name(at))
        })
    };
    let all = draft.gates_named(gate).iter().copied().take(SEARCHED);
    let is_candidate =
        |at: &usize| draft.component_name(*at) != component && !draft.gates[*at].duplicate && fits(draft, ends, *at);
    let found: Vec<usize> = all.filter(is_candidate).filter(|at| !is_at_other_end(*at)).collect();
    let open: Vec<usize> = found.iter().copied().filter(|at| !draft.gates[*at].named).collect();
    let best = if open.is_empty() { found } else { open };
    best.into_iter().take(MOST).collect()
}

/// The gate that fits and has no connection, if there is exactly one.
fn only_left(draft: &Draft<'_>, ends: &[End], component: &str) -> Option<usize> {
    let [link, end] = ends[0];
    draft.links[link].ends[1 - end]?;
    let mut open = draft.gates_of(component).filter(|at| !draft.gates[*at].named && fits(draft, ends, *at));
    open.next().filter(|_| open.next().is_none())
}

fn changed(places: &[Span], name: &str) -> Vec<Edit> {
    places.iter().map(|place| Edit::new(*place, name)).collect()
}

fn several_ways(draft: &Draft<'_>, found: Diagnostic, near: &[usize], places: &[Span]) -> Diagnostic {
    let names = near.iter().map(|&at| draft.gates[at].model.name.value.as_str());
    found.choose_all(("did you mean ", "?"), names.map(|name| (name, changed(places, name))))
}

/// Proposes to change the ends and, if no connection names the declared gate, its declaration: that first if several
/// connections name the unknown one.
fn one_way(draft: &Draft<'_>, found: Diagnostic, gate: &str, only: usize, places: &[Span]) -> Diagnostic {
    let name = &draft.gates[only].model.name.value;
    let has_uses = draft.gates[only].uses > 0;
    let rename = renamed(draft, gate, only).filter(|_| !has_uses);
    if let (Some(edit), [_, _, ..]) = (&rename, places) {
        let help = format!("rename the gate `{name}` to `{gate}`, as the connections call it");
        let found = found.suggest(help, [edit.clone()]);
        return found.suggest(format!("or write `{name}` in the connections"), changed(places, name));
    }
    let mut found = found.choose_all(("did you mean ", "?"), [(name.as_str(), changed(places, name))]);
    // The declaration may be misspelt as well, unless a connection names it. Numbered gates differ on purpose.
    let is_verbatim = places.iter().all(|place| draft.sources.snippet(*place) == gate);
    if !(has_uses && is_verbatim && digits(name) == digits(gate)) {
        found.doubt();
    }
    with_rename(found, name, gate, rename)
}

fn with_rename(found: Diagnostic, name: &str, gate: &str, rename: Option<Edit>) -> Diagnostic {
    match rename {
        Some(edit) => found.suggest(format!("or rename the gate `{name}` to `{gate}`"), [edit]),
        None => found,
    }
}

fn digits(name: &str) -> String {
    name.chars().filter(char::is_ascii_digit).collect()
}

/// The change of a gate's declaration.
fn renamed(draft: &Draft<'_>, to: &str, gate: usize) -> Option<Edit> {
    let place = draft.gates[gate].model.name.span;
    is_well_formed(to).then(|| Edit::new(place, draft.sources.quoted_as(place, to)))
}

/// Suggests the gates of other components.
fn elsewhere(draft: &Draft<'_>, found: Diagnostic, moved: &[usize], ends: &[End]) -> Diagnostic {
    let paths: Vec<String> = moved.iter().map(|&gate| draft.path(gate)).collect();
    let changed = |path: &str| {
        let spans = ends.iter().map(|&[link, end]| draft.links[link].model.ends[end].span);
        spans.map(|span| Edit::new(span, draft.sources.quoted_as(span, path))).collect::<Vec<_>>()
    };
    let ways = paths.iter().map(|path| (path.as_str(), changed(path)));
    let mut found = found.choose_all(("did you mean ", "?"), ways);
    if !moved.is_empty() {
        found.doubt();
    }
    found
}

/// Suggests the only gate that fits and is unconnected, although its name is another one.
fn unconnected(draft: &Draft<'_>, found: Diagnostic, gate: &str, left: usize, places: &[Span]) -> Diagnostic {
    let name = &draft.gates[left].model.name.value;
    let help = format!("{} fits and is not connected yet", draft.name_and_kind(left));
    let found = found.suggest(help, changed(places, name));
    with_rename(found, name, gate, renamed(draft, gate, left))
}

fn declare(draft: &Draft<'_>, [component, gate]: [&str; 2], [link, end]: End) -> String {
    let kind = draft.links[link].ends[1 - end].and_then(|other| draft.gates[other].kind).map(GateKind::opposite);
    match kind {
        Some(kind) => format!("declare it among the gates of `{component}`: `{gate}: {}`", kind.word()),
        None => format!("declare it among the gates of `{component}`"),
    }
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
                  = help: or rename the gate `measurements` to `measurement`
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
                   = help: or rename the gate `orders` to `order`
                   = note: gates of `pilot`: `orders` (rep), `border` (pub)
            "#]],
        );
    }
}
