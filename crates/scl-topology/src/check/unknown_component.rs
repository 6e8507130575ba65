//! SCL0501: an end of a component that does not exist. SCL0504: its two names are swapped.

use super::commented_out;
use super::draft::Draft;
use super::end::{End, with_places};
use super::named::Noun;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::habits::compact;
use crate::rust_name::{component_type, gate_field};
use crate::source::Span;
use crate::suggest::{MOST, nearest, similar};
use crate::topology::GateKind;
use scl_text::gate_name::split;
use scl_text::list::{listed, shortened};

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

/// Maximum number of components or ends that a search looks at.
const SEARCHED: usize = 32;

/// What an unknown component may mean.
#[derive(Default)]
struct Meant<'m> {
    names: Vec<&'m str>,
    /// The names look alike; otherwise the components only have gates that fit.
    is_similar: bool,
    /// No connection names the gates that are meant.
    is_open: bool,
}

/// Reports ends of an unknown component, which stands in a comment if `comment` is its name there.
pub(super) fn check<'m>(
    draft: &mut Draft<'m>,
    component: &'m str,
    comment: Option<Span>,
    ends: &[End],
    problems: &mut Diagnostics,
) {
    if draft.model.components_unread {
        return;
    }
    let headline = format!("unknown component `{component}`");
    let of_end = |&[link, end]: &End| draft.part(draft.links[link].model.ends[end].span, component, false);
    let places: Vec<Span> = ends.iter().map(of_end).collect();
    if let Some(comment) = comment {
        let found =
            UNKNOWN.at(headline, places[0], "no component has this name").label(comment, "this component is a comment");
        let found = match commented_out::with_connections(draft, ends) {
            Some(edits) => found.suggest("make comments of its connections, too", edits),
            None => found,
        };
        return problems.push(with_places(found.help(format!("or {}", declare(draft, component, ends))), &places));
    }
    let meant = if draft.may_search() { meant(draft, component, ends) } else { Meant::default() };
    mark(draft, &meant, ends);
    if meant.names.iter().any(|name| !Noun::Component.is_well_formed(name)) {
        // The declaration is reported, and its name may become this one.
        return;
    }
    let declarations = meant.names.iter().filter_map(|name| draft.component(name));
    let label = if meant.is_similar { "a similar name is declared here" } else { "has such gates" };
    let similar = declarations.map(|at| (draft.components[at].model.name.span, label));
    let found = UNKNOWN.at(headline, places[0], "no component has this name").labels(similar);
    let found = with_ways(draft, found, component, &meant, ends, &places).otherwise(declare(draft, component, ends));
    let note = match draft.is_group(component) {
        true => format!("`{component}` is a group; in it are {}", shortened(&members(draft, component))),
        false => declared(draft),
    };
    problems.push(with_places(found.note(note), &places));
}

/// The components in a group, in quotes.
fn members(draft: &Draft<'_>, group: &str) -> Vec<String> {
    let prefix = format!("{group}.");
    let names = &draft.component_names;
    let first = names.partition_point(|name| *name < prefix.as_str());
    names[first..].iter().take_while(|name| name.starts_with(&prefix)).map(|name| format!("`{name}`")).collect()
}

/// Says which gates the component would have.
fn declare(draft: &Draft<'_>, component: &str, ends: &[End]) -> String {
    let gate = |end: &End| {
        let kind = draft.links[end[0]].ends[1 - end[1]].and_then(|other| draft.gates[other].kind);
        let name = gate_name(draft, *end);
        kind.map_or_else(|| format!("`{name}`"), |kind| format!("`{name}` ({})", kind.opposite().word()))
    };
    let mut gates: Vec<String> = ends.iter().take(SEARCHED).map(gate).collect();
    gates.sort_unstable();
    gates.dedup();
    let noun = if gates.len() == 1 { "the gate" } else { "the gates" };
    let what = if ends.len() == 1 { "the connection" } else { "its connections" };
    format!("declare the component `{component}` with {noun} {}, or remove {what}", shortened(&gates))
}

/// Marks the gates that are meant as connected.
fn mark(draft: &mut Draft<'_>, meant: &Meant<'_>, ends: &[End]) {
    for (name, end) in meant.names.iter().flat_map(|name| ends.iter().map(move |end| (name, *end))) {
        if let Some(gate) = gate_of(draft, name, end) {
            draft.gates[gate].named = true;
        }
    }
}

/// Proposes to change the ends, the declaration, or either of them.
fn with_ways(
    draft: &Draft<'_>,
    found: Diagnostic,
    component: &str,
    meant: &Meant<'_>,
    ends: &[End],
    places: &[Span],
) -> Diagnostic {
    let is_verbatim = places.iter().all(|place| draft.sources.snippet(*place) == component);
    let changed = |name: &str| {
        let ends = ends.iter().zip(places);
        let whole = |end: &End| Some((draft.links[end[0]].model.ends[end[1]].span, respelt(draft, name, *end)?));
        let edit = |(end, place): (&End, &Span)| match whole(end) {
            Some((written, path)) => Edit::new(written, draft.sources.quoted_as(written, &path)),
            None => Edit::new(*place, name),
        };
        ends.map(edit).collect::<Vec<_>>()
    };
    let (&[only], true) = (meant.names.as_slice(), is_verbatim) else {
        let ways = meant.names.iter().map(|name| (*name, changed(name)));
        let mut found = found.choose_all(("did you mean ", "?"), ways);
        found.doubt();
        return found;
    };
    let has_uses = draft.uses_of(only) > 0;
    let declared = draft.component(only).map(|at| draft.components[at].model.name.span).filter(|_| !has_uses);
    let has_all = || ends.iter().all(|end| gate_of(draft, only, *end).is_some());
    let renamed = declared
        .filter(|_| Noun::Component.is_well_formed(component) && !draft.is_group(component) && has_all())
        .map(|at| Edit::new(at, draft.sources.quoted_as(at, component)));
    match renamed {
        // `SensorUnit` is only what Rust calls `sensor_unit`.
        Some(edit) if ends.len() > 1 && meant.is_similar && gate_field(component) == component => {
            let found = found.suggest(format!("rename `{only}` to `{component}`, as the connections call it"), [edit]);
            found.suggest(format!("or write `{only}` in the connections"), changed(only))
        }
        renamed => {
            let path = if let [end] = ends { respelt(draft, only, *end) } else { None };
            let word = path.as_deref().unwrap_or(only);
            let mut found = found.choose_all(("did you mean ", "?"), [(word, changed(only))]);
            // The declaration may be misspelt as well, unless a connection names it.
            if !(has_uses && meant.is_similar && meant.is_open) {
                found.doubt();
            }
            match renamed {
                Some(edit) => found.suggest(format!("or rename the component `{only}` to `{component}`"), [edit]),
                None => found,
            }
        }
    }
}

/// The end that is meant if its gate is written differently, too: `sensor.fix` for `SENSOR.FIX`.
fn respelt(draft: &Draft<'_>, component: &str, end: End) -> Option<String> {
    if gate_of(draft, component, end).is_some() {
        return None;
    }
    let word = compact(gate_name(draft, end));
    let gates = &draft.components[draft.component(component)?].gates;
    let mut same = gates.iter().filter(|gate| compact(&draft.gates[**gate].model.name.value) == word);
    let (gate, others) = (*same.next()?, same.next());
    others.is_none().then(|| draft.path(gate))
}

/// Reports ends whose two names are in the wrong order.
pub(super) fn swapped(draft: &mut Draft<'_>, [component, gate]: [&str; 2], ends: &[End], problems: &mut Diagnostics) {
    let headline = match draft.component(component) {
        None => format!("unknown component `{component}`"),
        Some(_) => format!("component `{component}` has no gate `{gate}`"),
    };
    if let Some(meant) = draft.gate(gate, component) {
        draft.gates[meant].named = true;
    }
    let meant = format!("{gate}.{component}");
    let places: Vec<Span> = ends.iter().map(|&[link, end]| draft.links[link].model.ends[end].span).collect();
    let edits = places.iter().map(|place| Edit::new(*place, draft.sources.quoted_as(*place, &meant)));
    let found =
        SWAPPED.at(headline, places[0], "component and gate are swapped").propose(format!("write `{meant}`"), edits);
    problems.push(with_places(found, &places));
}

/// Returns similar components that have the gates, or else those that have similar gates, or else any that has
/// unconnected gates of these names. Of equally similar ones, prefers those whose gates fit the other ends and are
/// unconnected.
fn meant<'m>(draft: &Draft<'m>, component: &str, ends: &[End]) -> Meant<'m> {
    let ends = &ends[..ends.len().min(SEARCHED)];
    let in_rust = component_type(component);
    let same = draft.component_names.iter().filter(|name| component_type(name) == in_rust);
    let mut near: Vec<&str> = same.take(SEARCHED).copied().collect();
    if near.is_empty() {
        near = nearest(component, draft.component_names.iter().copied());
    }
    near.truncate(SEARCHED);
    let has_all = |name: &str| ends.iter().all(|end| gate_of(draft, name, *end).is_some());
    let fits = |name: &str| ends.iter().all(|end| gate_of(draft, name, *end).is_none_or(|at| draft.fits(*end, at)));
    let is_open =
        |name: &str| ends.iter().all(|end| gate_of(draft, name, *end).is_none_or(|gate| !draft.gates[gate].named));
    let mut best: Vec<&str> = near.iter().copied().filter(|name| has_all(name)).collect();
    if best.is_empty() {
        best = near.into_iter().filter(|name| ends.iter().all(|end| has_similar(draft, name, *end))).collect();
    }
    keep_if_any(&mut best, fits);
    keep_if_any(&mut best, is_open);
    best.truncate(MOST);
    if !best.is_empty() {
        let is_open = best.iter().all(|name| is_open(name));
        return Meant { names: best, is_similar: true, is_open };
    }
    let holders = draft.gates_named(gate_name(draft, ends[0])).iter().take(SEARCHED);
    let mut holders: Vec<&str> = holders.map(|gate| draft.component_name(*gate)).collect();
    holders.dedup();
    let is_other = |name: &str| {
        ends.iter()
            .all(|&[link, end]| draft.links[link].ends[1 - end].is_none_or(|other| draft.component_name(other) != name))
    };
    holders.retain(|name| has_all(name) && fits(name) && is_other(name));
    let takes_more = |name: &str| {
        let kinds = ends.iter().filter_map(|end| draft.gates[gate_of(draft, name, *end)?].kind);
        kinds.into_iter().all(|kind| matches!(kind, GateKind::Pub | GateKind::Rep | GateKind::Pull))
    };
    match holders.iter().any(|name| is_open(name)) {
        true => holders.retain(|name| is_open(name)),
        // Any number of connections may name the same publisher.
        false => holders.retain(|name| takes_more(name)),
    }
    let shares_word = |name: &str| words(name).any(|word| words(component).any(|other| word == other));
    keep_if_any(&mut holders, shares_word);
    holders.truncate(MOST);
    Meant { names: holders, is_similar: false, is_open: true }
}

fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(['_', '-']).filter(|word| !word.is_empty())
}

fn gate_name<'m>(draft: &Draft<'m>, [link, end]: End) -> &'m str {
    split(&draft.links[link].model.ends[end].value).map_or("", |(_, gate)| gate)
}

/// The gate of the component `name` that has the name of the gate at an end.
fn gate_of(draft: &Draft<'_>, name: &str, end: End) -> Option<usize> {
    draft.gate(name, gate_name(draft, end))
}

fn has_similar(draft: &Draft<'_>, component: &str, end: End) -> bool {
    let gates = draft.gates_of(component).map(|at| draft.gates[at].model.name.value.as_str());
    gate_of(draft, component, end).is_some()
        || !similar(gate_name(draft, end), gates).is_empty()
        || draft.declarations(component).any(|twin| twin.gates_unread)
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
                  = help: or rename the component `controller` to `controler`
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
                  = help: declare the component `aircomm` with the gate `report` (pub), or remove the connection
                  = note: declared components: `aircomm_swarm`, `pilot`
            "#]],
        );
    }
}
