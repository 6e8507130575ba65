//! SCL0601: a sender and a receiver of different types. The connections of one gate are reported together, at the gate
//! if it alone differs from all its peers.

use super::draft::{Draft, differ, last};
use super::split_gate::{self, Part};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::topology::{GateKind, Payload, TypeName};
use scl_text::list::{all_of, listed};
use std::collections::{BTreeMap, HashSet};

/// SCL0601.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0601",
    severity: Severity::Error,
    title: "published and subscribed types differ",
    explanation: "The sender's message type is not the one that the receiver expects, so the receiver would misread \
                  every message. Such connections of one gate are reported together. Use one type at both ends, or put \
                  a component between them that converts.",
    example: " components:
   - name: autopilot
     gates:
       - attitude: {pub: Attitude}
   - name: blackbox
     gates:
-      - attitude: {sub: Telemetry}
+      - attitude: {sub: Attitude}
 connections:
   - [autopilot.attitude, blackbox.attitude]
",
};

/// Maximum number of types for which one gate is split.
const MOST_TYPES: usize = 4;

/// A connection whose ends differ: its index, and the gate at the other end of the gate it is grouped by.
type Peer = (usize, usize);

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let mut by_source: BTreeMap<usize, Vec<Peer>> = BTreeMap::new();
    for (link, source, sink) in draft.flows() {
        if let (Some(sent), Some(expected)) = (message(draft, source), message(draft, sink))
            && differ(sent, expected)
        {
            by_source.entry(source).or_default().push((link, sink));
        }
    }
    let mut by_sink: BTreeMap<usize, Vec<Peer>> = BTreeMap::new();
    for (source, peers) in by_source {
        match peers.as_slice() {
            [(link, sink)] => by_sink.entry(*sink).or_default().push((*link, source)),
            _ => problems.push(report(draft, source, &peers)),
        }
    }
    for (sink, peers) in by_sink {
        problems.push(report(draft, sink, &peers));
    }
}

fn message<'a>(draft: &'a Draft<'_>, gate: usize) -> Option<&'a TypeName> {
    match &draft.gates[gate].payload {
        Some(Payload::Message(name)) => Some(name),
        _ => None,
    }
}

fn report(draft: &Draft<'_>, hub: usize, peers: &[Peer]) -> Diagnostic {
    let wanted = |peer: usize| message(draft, peer).map(TypeName::dotted);
    let agreed = peers.iter().all(|&(_, peer)| wanted(peer) == wanted(peers[0].1));
    let all = draft.flows().filter(|&(_, source, sink)| source == hub || sink == hub).count() == peers.len();
    match peers {
        [_, _, ..] if agreed && all => hub_differs(draft, hub, peers),
        _ => connection_differs(draft, hub, peers),
    }
}

fn connection_differs(draft: &Draft<'_>, hub: usize, peers: &[Peer]) -> Diagnostic {
    let (link, peer) = peers[0];
    let [source, sink] = if is_source(draft, hub) { [hub, peer] } else { [peer, hub] };
    let (sent, expected) = (type_of(draft, source), type_of(draft, sink));
    let headline = match peers.len() {
        1 => "the two ends of this connection use different message types".to_owned(),
        more => format!("{more} connections of `{}` use different message types at their two ends", draft.path(hub)),
    };
    let label = format!("`{sent}` is sent, `{expected}` is expected");
    let found = with_type(draft, RULE.at(headline, draft.links[link].model.span, label), hub);
    let found = with_peers(draft, found, peers);
    let [sent_by, taken_by] =
        if is_source(draft, hub) { [vec![source], ends_of(peers)] } else { [ends_of(peers), vec![sink]] };
    let untyped = [source, sink].into_iter().find(|&gate| draft.gates[gate].payload_from.is_some());
    let found = match untyped {
        Some(gate) => one_gate_for_each_type(draft, found, gate),
        None => found,
    };
    let found = with_type_at(draft, found, &taken_by, source);
    let found = with_type_at(draft, found, &sent_by, sink);
    found.otherwise("both ends have one type, or a component between them converts")
}

/// Suggests a gate for each type, in place of one without a type that has peers of several types.
fn one_gate_for_each_type(draft: &Draft<'_>, found: Diagnostic, gate: usize) -> Diagnostic {
    let mut types: Vec<(&str, Vec<Peer>)> = Vec::new();
    for (link, source, sink) in draft.flows().filter(|&(_, source, sink)| source == gate || sink == gate) {
        let peer = if source == gate { sink } else { source };
        let Some(name) = message(draft, peer).map(TypeName::dotted) else { return found };
        match types.iter_mut().find(|(other, _)| *other == name) {
            Some((_, peers)) => peers.push((link, peer)),
            None => types.push((name, vec![(link, peer)])),
        }
        if types.len() > MOST_TYPES {
            return found;
        }
    }
    let gate_names: HashSet<&str> = types.iter().map(|(_, peers)| gate_name(draft, peers[0])).collect();
    let are_different = gate_names.len() == types.len();
    let part = |(_, peers): &(&str, Vec<Peer>)| {
        let (owner, name) = (draft.component_name(peers[0].1), gate_name(draft, peers[0]));
        let name = if are_different { name.to_owned() } else { format!("{owner}_{name}") };
        Part { name, links: peers.iter().map(|(link, _)| *link).collect() }
    };
    let parts: Vec<Part> = types.iter().map(part).collect();
    let names = all_of(&parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>());
    let help = format!("give `{}` one gate for each type: {names}", draft.component_name(gate));
    match parts.len() {
        0 | 1 => found,
        _ => split_gate::suggest(draft, found, gate, &parts, help),
    }
}

fn gate_name<'m>(draft: &Draft<'m>, (_, peer): Peer) -> &'m str {
    &draft.gates[peer].model.name.value
}

fn ends_of(peers: &[Peer]) -> Vec<usize> {
    peers.iter().map(|&(_, peer)| peer).collect()
}

/// Suggests the type of gate `of` for some gates, unless one of them takes its type from elsewhere, or has a message of
/// the schemas for which the other type seems to be another name.
fn with_type_at(draft: &Draft<'_>, found: Diagnostic, gates: &[usize], of: usize) -> Diagnostic {
    let Some(new) = message(draft, of) else { return found };
    let to = new.dotted();
    let is_name_of = |old: &TypeName| old.in_schemas() && !new.in_schemas() && last(old) == last(new);
    if gates.iter().any(|&gate| message(draft, gate).is_some_and(is_name_of)) {
        return found;
    }
    let edits: Option<Vec<Edit>> = gates.iter().map(|&gate| retyped(draft, gate, to)).collect();
    match edits.filter(|edits| !edits.is_empty()) {
        Some(edits) => {
            let paths = listed(gates.iter().map(|&gate| draft.path(gate)));
            found.suggest(format!("write `{to}` at {paths}"), edits)
        }
        None => found,
    }
}

/// The change of a gate's own type.
fn retyped(draft: &Draft<'_>, gate: usize, to: &str) -> Option<Edit> {
    let written = draft.gates[gate].model.payload.as_ref()?;
    Some(Edit::new(written.span, draft.sources.quoted_as(written.span, to)))
}

fn hub_differs(draft: &Draft<'_>, hub: usize, peers: &[Peer]) -> Diagnostic {
    let (own, theirs) = (type_of(draft, hub), type_of(draft, peers[0].1));
    let path = draft.path(hub);
    let (headline, verb) = match is_source(draft, hub) {
        true => (format!("`{path}` sends `{own}`, but all its receivers expect `{theirs}`"), "sent"),
        false => (format!("`{path}` expects `{own}`, but all its senders send `{theirs}`"), "expected"),
    };
    let place = message(draft, hub).map_or(draft.gates[hub].model.span, TypeName::span);
    let found = with_peers(draft, RULE.at(headline, place, verb), peers);
    let paths = peers.iter().map(|&(_, peer)| draft.path(peer));
    let found = found.note(format!("the other ends agree: {}", listed(paths)));
    match retyped(draft, hub, theirs) {
        Some(edit) => found.suggest(format!("write `{theirs}` at `{path}`"), [edit]),
        None => found,
    }
    .otherwise("both ends have one type, or a component between them converts")
}

fn with_peers(draft: &Draft<'_>, found: Diagnostic, peers: &[Peer]) -> Diagnostic {
    peers.iter().fold(found, |found, &(_, peer)| with_type(draft, found, peer))
}

/// Adds a label to the type of a gate, unless it has one already: several gates may take their type from one place.
fn with_type(draft: &Draft<'_>, found: Diagnostic, gate: usize) -> Diagnostic {
    let Some(name) = message(draft, gate) else { return found };
    if found.secondary.iter().any(|label| label.span == name.span()) {
        return found;
    }
    let role = if is_source(draft, gate) { "sent" } else { "expected" };
    match draft.gates[gate].payload_from {
        Some(_) => {
            found.label(name.span(), format!("{role} by `{}`, which takes its type from here", draft.path(gate)))
        }
        None => found.label(name.span(), role),
    }
}

fn is_source(draft: &Draft<'_>, gate: usize) -> bool {
    draft.gates[gate].kind.is_some_and(GateKind::is_source)
}

fn type_of<'a>(draft: &'a Draft<'_>, gate: usize) -> &'a str {
    message(draft, gate).map_or("", TypeName::dotted)
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice_with, example, rule_example};
    use expect_test::expect;

    #[test]
    fn published_and_subscribed_types_differ() {
        rule_example(
            &RULE,
            expect![[r#"
                error: [SCL0601] the two ends of this connection use different message types
                 --> topology.yaml:9:5
                  |
                4 |       - attitude: {pub: Attitude}
                  |                         -------- sent
                ...
                7 |       - attitude: {sub: Telemetry}
                  |                         --------- expected
                8 | connections:
                9 |   - [autopilot.attitude, blackbox.attitude]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `Attitude` is sent, `Telemetry` is expected
                  |
                  = help: write `Attitude` at `blackbox.attitude`
                  = help: write `Telemetry` at `autopilot.attitude`
            "#]],
        );
    }

    #[test]
    fn a_publisher_that_alone_differs_is_pointed_at() {
        let yaml = "
components:
  - name: gps
    gates:
      - fix: {pub: Fix}
  - name: log
    gates:
      - fix: {sub: Place}
  - name: view
    gates:
      - fix: {sub: Place}
  - name: pilot
    gates:
      - fix: {sub: Place}
connections:
  - [gps.fix, log.fix]
  - [gps.fix, view.fix]
  - [gps.fix, pilot.fix]
";
        example(
            "SCL0601",
            yaml.trim_start(),
            expect![[r#"
                error: [SCL0601] `gps.fix` sends `Fix`, but all its receivers expect `Place`
                  --> topology.yaml:4:20
                   |
                 4 |       - fix: {pub: Fix}
                   |                    ^^^ sent
                ...
                 7 |       - fix: {sub: Place}
                   |                    ----- expected
                ...
                10 |       - fix: {sub: Place}
                   |                    ----- expected
                ...
                13 |       - fix: {sub: Place}
                   |                    ----- expected
                   |
                   = help: write `Place` at `gps.fix`
                   = note: the other ends agree: `log.fix`, `view.fix`, `pilot.fix`
            "#]],
        );
    }

    #[test]
    fn subscribers_of_one_publisher_are_reported_together() {
        let yaml = "
components:
  - name: gps
    gates:
      - fix: {pub: Fix}
  - name: log
    gates:
      - fix: {sub: Place}
  - name: view
    gates:
      - fix: {sub: Fix}
  - name: pilot
    gates:
      - fix: {sub: Position}
connections:
  - [gps.fix, log.fix]
  - [gps.fix, view.fix]
  - [gps.fix, pilot.fix]
";
        example(
            "SCL0601",
            yaml.trim_start(),
            expect![[r#"
                error: [SCL0601] 2 connections of `gps.fix` use different message types at their two ends
                  --> topology.yaml:15:5
                   |
                 4 |       - fix: {pub: Fix}
                   |                    --- sent
                ...
                 7 |       - fix: {sub: Place}
                   |                    ----- expected
                ...
                13 |       - fix: {sub: Position}
                   |                    -------- expected
                14 | connections:
                15 |   - [gps.fix, log.fix]
                   |     ^^^^^^^^^^^^^^^^^^ `Fix` is sent, `Place` is expected
                   |
                   = help: write `Fix` at `log.fix`, `pilot.fix`
            "#]],
        );
    }

    #[test]
    fn a_type_of_no_schema_is_not_spread() {
        let yaml = "
schemas: [met.proto]
components:
  - name: mast
    gates:
      - rain: {pub: weather.Rain}
  - name: qc
    gates:
      - rain: {sub: met.Rain}
connections:
  - [mast.rain, qc.rain]
";
        let told = advice_with(&RULE, yaml.trim_start(), &["met.Rain"]);
        let expected = "the two ends of this connection use different message types [write `met.Rain` at `mast.rain`]";
        assert_eq!(told, expected);
    }
}
