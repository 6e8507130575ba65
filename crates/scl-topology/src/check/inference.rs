//! Types and codecs that one end leaves out are taken over from the other, and by the components of a kind from each
//! other. SCL0607, a lint, says where; SCL0402, a lint, finds the connections on which neither end has a type.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::rust_name::example_type;
use crate::topology::{GateKind, Payload};
use std::collections::VecDeque;

/// SCL0402.
pub(crate) const UNTYPED: Rule = Rule {
    code: "SCL0402",
    severity: Severity::Lint,
    title: "connection without a message type",
    explanation: "Neither end of the connection names a message type, so it carries bytes, and no compiler checks \
                  their content. That is allowed; the paper's first listing does it. One typed end is enough; the \
                  other takes over its type.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: pub
+      - measurements: {pub: Measurement}
   - name: controller
     gates:
       - sensor: sub
 connections:
   - [sensor.measurements, controller.sensor]
",
};

/// SCL0607.
pub(crate) const TAKEN_OVER: Rule = Rule {
    code: "SCL0607",
    severity: Severity::Lint,
    title: "type taken over from the other end",
    explanation: "One end has no type and takes that of the other. This is allowed for convenience; the lint is for \
                  teams that want the contract written at both ends.",
    example: " components:
   - name: sensor
     gates:
       - measurements: {pub: Measurement}
   - name: controller
     gates:
-      - sensor: sub
+      - sensor: {sub: Measurement}
 connections:
   - [sensor.measurements, controller.sensor]
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    let neighbours = neighbours(draft);
    take_over_types(draft, &neighbours);
    take_over_codecs(draft, &neighbours);
    for gate in 0..draft.gates.len() {
        let origin = draft.gates[gate].payload_from;
        problems.extend(origin.and_then(|origin| taken_over(draft, gate, origin)));
    }
    for (link, source, sink) in draft.flows() {
        let untyped = |gate: usize| draft.gates[gate].payload == Some(Payload::Bytes);
        if untyped(source) && untyped(sink) {
            problems.push(without_type(draft, link, source));
        }
    }
}

/// By gate: the gates at the other ends of its connections, and the same gate of other components of its kind.
fn neighbours(draft: &Draft<'_>) -> Vec<Vec<usize>> {
    let peers = draft.links_by_gate().into_iter().map(|links| links.into_iter().map(|(_, peer)| peer).collect());
    let mut neighbours: Vec<Vec<usize>> = peers.collect();
    for gate in 0..draft.gates.len() {
        let shared = draft.shared(gate);
        if shared != gate {
            neighbours[gate].push(shared);
            neighbours[shared].push(gate);
        }
    }
    neighbours
}

/// Spreads types from the gates that have one, breadth first, so that each gate gets the type of the nearest typed
/// gate, or of the first in the file if several are equally near.
fn take_over_types(draft: &mut Draft<'_>, neighbours: &[Vec<usize>]) {
    let is_typed = |gate: &usize| !matches!(draft.gates[*gate].payload, None | Some(Payload::Bytes));
    let mut reached: VecDeque<usize> = (0..draft.gates.len()).filter(is_typed).collect();
    while let Some(gate) = reached.pop_front() {
        for &peer in &neighbours[gate] {
            if draft.gates[peer].payload == Some(Payload::Bytes) {
                draft.gates[peer].payload = draft.gates[gate].payload.clone();
                draft.gates[peer].payload_from = Some(draft.gates[gate].payload_from.unwrap_or(gate));
                reached.push_back(peer);
            }
        }
    }
}

fn take_over_codecs(draft: &mut Draft<'_>, neighbours: &[Vec<usize>]) {
    let has_codec = |gate: &usize| draft.gates[*gate].codec.is_some();
    let mut reached: VecDeque<usize> = (0..draft.gates.len()).filter(has_codec).collect();
    while let Some(gate) = reached.pop_front() {
        for &peer in &neighbours[gate] {
            if draft.gates[peer].codec.is_none() && !draft.gates[peer].codec_broken {
                draft.gates[peer].codec = draft.gates[gate].codec.clone();
                reached.push_back(peer);
            }
        }
    }
}

fn taken_over(draft: &Draft<'_>, gate: usize, origin: usize) -> Option<Diagnostic> {
    let written = draft.gates[origin].model.payload.as_ref()?;
    let model = draft.gates[gate].model;
    let (text, from) = (written.value.trim(), draft.path(origin));
    let headline = format!("gate `{}` has no type of its own; it takes `{text}` from `{from}`", draft.path(gate));
    let (name, kind) = (&model.name.value, &model.kind.value);
    let found = TAKEN_OVER.at(headline, model.span, format!("inferred: `{text}`")).label(written.span, "from here");
    let edit = draft.with_type(gate, text);
    let written = edit.as_ref().and_then(|edit| draft.entry_with(gate, std::slice::from_ref(edit)));
    let help = format!("write `{}` to pin the contract", written.unwrap_or(format!("{name}: {{{kind}: {text}}}")));
    Some(match edit {
        Some(edit) => found.suggest(help, [edit]),
        None => found.help(help),
    })
}

fn without_type(draft: &Draft<'_>, link: usize, source: usize) -> Diagnostic {
    let headline = "this connection carries bytes of no declared type";
    let ends = draft.links[link].ends.into_iter().flatten();
    let model = draft.gates[source].model;
    let (name, kind) = (&model.name.value, &model.kind.value);
    let types = match draft.gates[source].kind {
        Some(GateKind::Req) => format!("{} -> Status", example_type(name)),
        _ => example_type(name),
    };
    UNTYPED
        .at(headline, draft.links[link].model.span, "neither end names a type")
        .labels(ends.map(|gate| (draft.gates[gate].model.span, "no type")))
        .help(format!("name it on one end: `{name}: {{{kind}: {types}}}`; the other end takes it over"))
}

#[cfg(test)]
mod tests {
    use super::{TAKEN_OVER, UNTYPED};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn connection_without_a_message_type() {
        rule_example(
            &UNTYPED,
            expect![[r#"
            warning: [SCL0402] this connection carries bytes of no declared type
             --> topology.yaml:9:5
              |
            4 |       - measurements: pub
              |         ----------------- no type
            ...
            7 |       - sensor: sub
              |         ----------- no type
            8 | connections:
            9 |   - [sensor.measurements, controller.sensor]
              |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ neither end names a type
              |
              = help: name it on one end: `measurements: {pub: Measurement}`; the other end takes it over
        "#]],
        );
    }

    #[test]
    fn type_taken_over_from_the_other_end() {
        rule_example(
            &TAKEN_OVER,
            expect![[r#"
            warning: [SCL0607] gate `controller.sensor` has no type of its own; it takes `Measurement` from `sensor.measurements`
             --> topology.yaml:7:9
              |
            4 |       - measurements: {pub: Measurement}
              |                             ----------- from here
            ...
            7 |       - sensor: sub
              |         ^^^^^^^^^^^ inferred: `Measurement`
              |
              = help: write `sensor: {sub: Measurement}` to pin the contract
        "#]],
        );
    }
}
