//! SCL0505: both ends send, or both receive. SCL0506: the ends belong to different patterns. Finds source and sink of
//! every other connection.

use super::draft::Draft;
use super::fitting_gate::FittingGates;
use super::unconnected::type_text;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::topology::GateKind;

/// Maximum number of gates that are proposed for an end.
const MOST: usize = 3;

/// SCL0505.
pub(crate) const SAME_DIRECTION: Rule = Rule {
    code: "SCL0505",
    severity: Severity::Error,
    title: "both ends send, or both receive",
    explanation: "A connection has one end that sends and one that receives. Here both send, or both receive, so \
                  nothing would ever arrive. Usually one of the kinds is wrong, or another gate was meant.",
    example: " components:
   - name: gps
     gates:
       - fix: pub
   - name: imu
     gates:
-      - rate: pub
+      - rate: sub
 connections:
   - [gps.fix, imu.rate]
",
};

/// SCL0506.
pub(crate) const OTHER_PATTERN: Rule = Rule {
    code: "SCL0506",
    severity: Severity::Error,
    title: "ends of different patterns",
    explanation: "The two gates belong to different patterns: for example, one publishes and the other expects an \
                  answer. `pub` connects to `sub`, `req` to `rep`, `push` to `pull`. The message shows which gates of \
                  the two components would fit.",
    example: " components:
   - name: controller
     gates:
       - commands: rep
       - events: pub
   - name: ui
     gates:
       - commands: req
       - events: sub
 connections:
-  - [controller.events, ui.commands]
+  - [controller.events, ui.events]
+  - [controller.commands, ui.commands]
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    let mut unpaired = Vec::new();
    for link in 0..draft.links.len() {
        let [Some(a), Some(b)] = draft.links[link].ends else { continue };
        let (Some(kind_a), Some(kind_b)) = (draft.gates[a].kind, draft.gates[b].kind) else { continue };
        if a == b {
            continue;
        }
        if kind_a.opposite() == kind_b {
            draft.links[link].flow = Some(if kind_a.is_source() { (a, b) } else { (b, a) });
            continue;
        }
        // The kind of a gate with too few or too many types may be wrong, which is reported already.
        if kind_a != kind_b && (draft.gates[a].is_misfit || draft.gates[b].is_misfit) {
            continue;
        }
        unpaired.push((link, [a, b], [kind_a, kind_b]));
    }
    if unpaired.is_empty() {
        return;
    }
    let others = FittingGates::of(draft);
    for (link, gates, kinds) in unpaired {
        let partners = [0, 1].map(|end| partners(draft, &others, [link, end]));
        problems.push(match kinds[0] == kinds[1] {
            true => same_direction(draft, link, gates, kinds[0], &partners),
            false => different_patterns(draft, link, gates, kinds, &partners),
        });
        partners.into_iter().flatten().for_each(|gate| draft.gates[gate].named = true);
    }
}

fn same_direction(
    draft: &Draft<'_>,
    link: usize,
    [a, b]: [usize; 2],
    kind: GateKind,
    partners: &[Vec<usize>; 2],
) -> Diagnostic {
    let (both, one, nobody) = match kind {
        GateKind::Pub => ("publish", "sends", "nobody receives"),
        GateKind::Sub => ("subscribe", "receives", "nobody sends"),
        GateKind::Req => ("ask", "asks", "nobody answers"),
        GateKind::Rep => ("answer", "answers", "nobody asks"),
        GateKind::Push => ("push", "sends", "nobody receives"),
        GateKind::Pull => ("pull", "receives", "nobody sends"),
    };
    let headline = format!("both ends of this connection {both}");
    let found = SAME_DIRECTION
        .at(headline, draft.links[link].model.span, nobody)
        .label(draft.gates[a].model.kind.span, one)
        .label(draft.gates[b].model.kind.span, format!("{one} too"))
        .help(format!("a `{}` gate connects to a `{}` gate", kind.word(), kind.opposite().word()));
    let found = match partners.iter().all(Vec::is_empty) {
        true => found.note(nobody_is(draft, [a, b], kind.opposite())),
        false => found,
    };
    with_ways(draft, found, link, partners)
}

fn nobody_is(draft: &Draft<'_>, [a, b]: [usize; 2], kind: GateKind) -> String {
    let owners = [a, b].map(|gate| draft.component_name(gate));
    let has_one = |owner: &&str| draft.gates_of(owner).any(|gate| draft.gates[gate].kind == Some(kind));
    let that = if owners.iter().any(has_one) { " that fits" } else { "" };
    match owners {
        [a, b] if a == b => format!("no gate of `{a}` is a `{}`{that}", kind.word()),
        [a, b] => format!("no gate of `{a}` or `{b}` is a `{}`{that}", kind.word()),
    }
}

fn different_patterns(
    draft: &Draft<'_>,
    link: usize,
    [a, b]: [usize; 2],
    kinds: [GateKind; 2],
    partners: &[Vec<usize>; 2],
) -> Diagnostic {
    let [a_word, b_word] = kinds.map(GateKind::word);
    let headline = format!("a `{a_word}` gate cannot be connected to a `{b_word}` gate");
    let found = OTHER_PATTERN
        .at(headline, draft.links[link].model.span, "")
        .label(draft.gates[a].model.span, doing(kinds[0]))
        .label(draft.gates[b].model.span, doing(kinds[1]))
        .note("pairs that fit: pub - sub, req - rep, push - pull");
    with_ways(draft, found, link, partners)
}

/// Suggests other gates for one of the ends, first those of the component that the end names, and other kinds for the
/// two gates.
fn with_ways(draft: &Draft<'_>, mut found: Diagnostic, link: usize, partners: &[Vec<usize>; 2]) -> Diagnostic {
    let [Some(a), Some(b)] = draft.links[link].ends else { return found };
    for (end, partners) in partners.iter().enumerate() {
        let span = draft.links[link].model.ends[end].span;
        let stays = draft.path([b, a][end]);
        for &partner in partners {
            let path = draft.path(partner);
            let edit = Edit::new(span, draft.sources.quoted_as(span, &path));
            found = found.suggest(format!("connect `{stays}` to {}", draft.path_and_kind(partner)), [edit]);
        }
    }
    for [gate, partner] in [[a, b], [b, a]] {
        if let Some((kind, edits)) = other_kind(draft, gate, partner) {
            found = found.suggest(format!("make `{}` a `{}` gate", draft.path(gate), kind.word()), edits);
        }
    }
    found
}

/// The changes that give a gate the kind that fits its partner, with the partner's types if their number differs.
fn other_kind(draft: &Draft<'_>, gate: usize, partner: usize) -> Option<(GateKind, Vec<Edit>)> {
    let kind = draft.gates[partner].kind?.opposite();
    let asks = |kind: GateKind| matches!(kind, GateKind::Req | GateKind::Rep);
    let types = (asks(kind) != asks(draft.gates[gate].kind?)).then(|| type_text(draft, partner));
    Some((kind, draft.with_kind(gate, kind, types.as_deref())?))
}

fn doing(kind: GateKind) -> &'static str {
    match kind {
        GateKind::Pub => "publishes, gets no answer",
        GateKind::Sub => "receives, gives no answer",
        GateKind::Req => "asks, waits for an answer",
        GateKind::Rep => "answers",
        GateKind::Push => "hands on work, gets no answer",
        GateKind::Pull => "takes work, gives no answer",
    }
}

/// The gates that the other end could be connected to instead of this one: in the same component the gate of its
/// own name, else the only one that fits; in other components those with which this one is connected, too, and the
/// senders that fit a receiver.
fn partners(draft: &Draft<'_>, others: &FittingGates<'_>, [link, end]: [usize; 2]) -> Vec<usize> {
    let [Some(gate), Some(other)] = [draft.links[link].ends[1 - end], draft.links[link].ends[end]] else {
        return Vec::new();
    };
    let own = draft.gates_of(draft.component_name(other));
    let fits: Vec<usize> = own.filter(|&at| at != gate && at != other && draft.may_connect(gate, at)).collect();
    let name = &draft.gates[gate].model.name.value;
    let namesake = fits.iter().find(|&&at| draft.gates[at].model.name.value == *name);
    if let Some(best) = namesake.or(if fits.len() == 1 { fits.first() } else { None }) {
        return vec![*best];
    }
    let is_far = |at: usize| draft.component_name(at) != draft.component_name(gate);
    let mut found: Vec<usize> = others.peers(other).filter(|&at| is_far(at) && draft.may_connect(gate, at)).collect();
    if draft.gates[gate].model.payload.is_some() {
        let is_sender = |at: usize| draft.gates[at].kind.is_some_and(GateKind::is_source);
        let senders = others.for_gate(draft, gate).into_iter().filter(|&at| is_sender(at) && at != other);
        for sender in senders {
            if !found.contains(&sender) {
                found.push(sender);
            }
        }
    }
    found.truncate(MOST);
    found
}

#[cfg(test)]
mod tests {
    use super::{OTHER_PATTERN, SAME_DIRECTION};
    use crate::check::testing::{example, rule_example};
    use expect_test::expect;

    #[test]
    fn both_ends_send_or_both_receive() {
        rule_example(
            &SAME_DIRECTION,
            expect![[r#"
                error: [SCL0505] both ends of this connection publish
                 --> topology.yaml:9:5
                  |
                4 |       - fix: pub
                  |              --- sends
                ...
                7 |       - rate: pub
                  |               --- sends too
                8 | connections:
                9 |   - [gps.fix, imu.rate]
                  |     ^^^^^^^^^^^^^^^^^^^ nobody receives
                  |
                  = help: a `pub` gate connects to a `sub` gate
                  = help: make `gps.fix` a `sub` gate
                  = help: make `imu.rate` a `sub` gate
                  = note: no gate of `gps` or `imu` is a `sub`
            "#]],
        );
    }

    #[test]
    fn ends_of_different_patterns() {
        rule_example(
            &OTHER_PATTERN,
            expect![[r#"
                error: [SCL0506] a `pub` gate cannot be connected to a `req` gate
                  --> topology.yaml:11:5
                   |
                 5 |       - events: pub
                   |         ----------- publishes, gets no answer
                ...
                 8 |       - commands: req
                   |         ------------- asks, waits for an answer
                ...
                11 |   - [controller.events, ui.commands]
                   |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
                   |
                   = help: connect `ui.commands` to `controller.commands` (rep)
                   = help: make `controller.events` a `rep` gate
                   = help: make `ui.commands` a `sub` gate
                   = note: pairs that fit: pub - sub, req - rep, push - pull
            "#]],
        );
    }

    #[test]
    fn a_gate_that_fits_is_offered() {
        let yaml = "
components:
  - name: gps
    gates:
      - fix: pub
  - name: pilot
    gates:
      - fix_out: pub
      - fix: sub
connections:
  - [gps.fix, pilot.fix_out]
";
        example(
            "SCL0505",
            yaml.trim_start(),
            expect![[r#"
                error: [SCL0505] both ends of this connection publish
                  --> topology.yaml:10:5
                   |
                 4 |       - fix: pub
                   |              --- sends
                ...
                 7 |       - fix_out: pub
                   |                  --- sends too
                ...
                10 |   - [gps.fix, pilot.fix_out]
                   |     ^^^^^^^^^^^^^^^^^^^^^^^^ nobody receives
                   |
                   = help: a `pub` gate connects to a `sub` gate
                   = help: connect `gps.fix` to `pilot.fix` (sub)
                   = help: make `gps.fix` a `sub` gate
                   = help: make `pilot.fix_out` a `sub` gate
            "#]],
        );
    }
}
