//! SCL0408: an option on a kind of gate that has no use for it. SCL0409: an option value out of its range. Sets the
//! options of every gate.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::grammar::{self, GateKind, GateOption, OutOfRange};
use crate::model::OptionModel;
use scl_text::gate_name::split;
use scl_text::list::{all_of, listed};
use std::collections::HashMap;

/// SCL0409.
pub(crate) const VALUE: Rule = Rule {
    code: "SCL0409",
    severity: Severity::Error,
    title: "option value out of range",
    explanation: "The value is outside the option's range: a queue holds at least one message, a timeout is longer \
                  than zero, and a message has to fit in memory. The message names the range; so does `scl explain` \
                  with the option's name, as in `scl explain queue`. Correct the value, or leave it out to get the \
                  default.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {sub: Measurement, queue: 0}
+      - measurements: {sub: Measurement, queue: 1}
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    let mut misfits: Vec<(usize, &OptionModel)> = Vec::new();
    for at in 0..draft.gates.len() {
        let gate = &draft.gates[at];
        let mut kept = gate.options.clone();
        for option in &gate.model.options {
            let Some(row) = grammar::option(&option.key.value) else { continue };
            let mut options = kept.clone();
            match row.set(&mut options, &option.value.value) {
                // An option that the kind does not have has no effect, so nothing follows from it.
                _ if gate.kind.is_some_and(|kind| !row.fits(kind)) => misfits.push((at, option)),
                Ok(()) => kept = options,
                Err(range) => problems.push(report(draft, at, row, option, &range)),
            }
        }
        draft.gates[at].options = kept;
    }
    if misfits.is_empty() {
        return;
    }
    let peers = peers(draft);
    let peers = |gate: usize| peers.get(&gate).map_or(&[][..], Vec::as_slice);
    problems.extend(misfits.into_iter().filter_map(|(gate, option)| misfit_at(draft, gate, option, peers(gate))));
}

/// The gates at the other ends of each gate's connections, as they are written.
fn peers(draft: &Draft<'_>) -> HashMap<usize, Vec<usize>> {
    let mut peers: HashMap<usize, Vec<usize>> = HashMap::new();
    let gate = |end: &str| split(end).and_then(|(component, gate)| draft.gate(component, gate));
    for connection in &draft.model.connections {
        let [one, other] = &connection.ends;
        if let (Some(one), Some(other)) = (gate(&one.value), gate(&other.value)) {
            peers.entry(one).or_default().push(other);
            peers.entry(other).or_default().push(one);
        }
    }
    peers
}

fn report(draft: &Draft<'_>, gate: usize, row: &GateOption, option: &OptionModel, range: &OutOfRange) -> Diagnostic {
    let headline = format!("`{}` must be {}", row.key, range.rule);
    let key = row.key;
    let mut found = VALUE.at(headline, option.value.span, "").notes(range.reason);
    if key == "queue" && !range.is_too_large {
        let text = "`queue: 1` keeps one message, and is the shortest queue";
        found = found.suggest(text, [Edit::new(option.value.span, "1")]);
    }
    if let Some(largest) = row.shape.largest() {
        // In other tools, 0 and -1 mean that there is no limit.
        let text = match range.is_too_large {
            true => format!("the largest is `{key}: {largest}`"),
            false => format!("there is no unlimited `{key}`; the largest is `{key}: {largest}`"),
        };
        found = found.suggest(text, [Edit::new(option.value.span, largest)]);
    }
    if let (Some(default), Some(edit)) = (row.default(), draft.without_option(gate, key)) {
        found = found.suggest(format!("without it, the default is {default}"), [edit]);
    }
    found
}

/// SCL0408.
pub(crate) const MISFIT: Rule = Rule {
    code: "SCL0408",
    severity: Severity::Error,
    title: "option does not fit the kind",
    explanation: "The option exists, but not for this kind of gate: `queue` and `max_size` belong to the receiving \
                  end, `timeout` to the requester. Move it to the other end, or remove it.",
    example: " components:
   - name: ui
     gates:
-      - commands: {req: Command -> Status, queue: 8}
+      - commands: {req: Command -> Status, timeout: 1s, unconnected: ok}
",
};

/// Maximum number of gates to which a proposal moves an option.
const MOST_MOVED: usize = 10;

/// The problem of an option that this kind of gate does not have.
fn misfit_at(draft: &Draft<'_>, gate: usize, option: &OptionModel, peers: &[usize]) -> Option<Diagnostic> {
    let key = option.key.value.as_str();
    let kind = draft.gates[gate].kind?;
    let rule = misfit(Some(kind), key)?;
    let headline = match draft.sources.snippet(option.key.span) {
        written if written.trim_matches(['"', '\'']) != key => {
            format!("`{written}` is called `{key}` here, and is not available on a `{}` gate", kind.word())
        }
        _ => format!("option `{key}` is not available on a `{}` gate", kind.word()),
    };
    let mut found = MISFIT.at(headline, option.key.span, "");
    let removed = draft.without_option(gate, key);
    let other = kind.opposite();
    let others = peers.iter().filter(|&&peer| fits(other, key) && draft.gates[peer].kind == Some(other));
    let (having, lacking): (Vec<usize>, Vec<usize>) =
        others.partition(|&&peer| draft.gates[peer].option(key).is_some());
    let listed = |gates: &[usize]| listed(gates.iter().map(|&gate| draft.path(gate)));
    let have = match having.len() {
        1 => format!("{} has its own", listed(&having)),
        _ => format!("{} each have their own", listed(&having)),
    };
    let is_moved = (1..=MOST_MOVED).contains(&lacking.len());
    // At its end, a sender that waits exerts backpressure.
    let waits = key == "when_full" && option.value.value == "wait" && fits(kind, "backpressure");
    if waits && is_moved && draft.gates[gate].option("backpressure").is_none() {
        let here = Edit::new(option.key.span.to(option.value.span), "backpressure: true");
        let there = lacking.iter().map(|&peer| draft.with_option(peer, key, "wait"));
        let text = format!("write `backpressure: true` here, and `when_full: wait` at {}", listed(&lacking));
        found = found.suggest(text, there.chain([here]));
    }
    if let (true, Some(removed)) = (is_moved, &removed) {
        let value = &option.value.value;
        let there = lacking.iter().map(|&peer| draft.with_option(peer, key, value));
        let but = if having.is_empty() { String::new() } else { format!("; {have}") };
        let text = format!("write `{key}: {value}` at {}{but}", listed(&lacking));
        found = found.suggest(text, there.chain([removed.clone()]));
    }
    let is_needless = lacking.is_empty() && !having.is_empty();
    found = match removed {
        Some(removed) if is_needless => found.suggest(format!("remove it: {have}"), [removed]),
        Some(removed) => found.suggest("remove it", [removed]),
        None => found,
    };
    found = with_other_kinds(draft, found, gate, peers, key);
    let at_other_end = fits(other, key).then(|| format!("it belongs to the `{}` end of a connection", other.word()));
    Some(found.helps(at_other_end.filter(|_| !is_moved)).note(rule))
}

/// Suggests the kinds of another pattern that has the option, for a gate and all gates to which it is connected.
fn with_other_kinds(draft: &Draft<'_>, found: Diagnostic, gate: usize, peers: &[usize], key: &str) -> Diagnostic {
    // Requests have two types, so they do not become messages.
    let one_type = |kind: GateKind| !matches!(kind, GateKind::Req | GateKind::Rep);
    let Some(kind) = draft.gates[gate].kind.filter(|kind| one_type(*kind)) else { return found };
    let is_way = |other: &GateKind| {
        *other != kind && one_type(*other) && other.is_source() == kind.is_source() && fits(*other, key)
    };
    let Some(way) = GateKind::ALL.into_iter().find(is_way).filter(|_| (1..=MOST_MOVED).contains(&peers.len())) else {
        return found;
    };
    let changed = peers.iter().map(|&peer| draft.with_kind(peer, way.opposite(), None));
    let edits: Option<Vec<Vec<Edit>>> = std::iter::once(draft.with_kind(gate, way, None)).chain(changed).collect();
    let Some(edits) = edits else { return found };
    let peers: Vec<String> = peers.iter().map(|&peer| draft.path(peer)).collect();
    let (own, others) = (way.word(), way.opposite().word());
    let text = match peers.as_slice() {
        [peer] => format!("or make this a `{own}` gate, and `{peer}` a `{others}` gate"),
        peers => format!("or make this a `{own}` gate, and each of {} a `{others}` gate", listed(peers)),
    };
    found.suggest(text, edits.concat())
}

/// Returns why a kind does not have the option, or `None` if it does.
fn misfit(kind: Option<GateKind>, key: &str) -> Option<String> {
    let kind = kind.filter(|&kind| !fits(kind, key))?;
    let option = grammar::option(key)?;
    let words: Vec<&str> = option.kinds.iter().map(|kind| kind.word()).collect();
    let belongs = format!("`{key}` is for {}", all_of(&words));
    Some(match option.reason(kind) {
        Some(reason) => format!("{reason}; {belongs}"),
        None => belongs,
    })
}

fn fits(kind: GateKind, key: &str) -> bool {
    grammar::option(key).is_none_or(|option| option.fits(kind))
}

#[cfg(test)]
mod tests {
    use super::{MISFIT, VALUE};
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn option_value_out_of_range() {
        rule_example(
            &VALUE,
            expect![[r#"
                error: [SCL0409] `queue` must be at least 1
                 --> topology.yaml:4:49
                  |
                4 |       - measurements: {sub: Measurement, queue: 0}
                  |                                                 ^
                  |
                  = help: `queue: 1` keeps one message, and is the shortest queue
                  = help: there is no unlimited `queue`; the largest is `queue: 1000000`
                  = help: without it, the default is 100
            "#]],
        );
    }

    #[test]
    fn ranges_have_two_ends() {
        let gates = [
            "sub: T, queue: 1",
            "sub: T, queue: -3",
            "sub: T, queue: 1000000",
            "sub: T, queue: 1000001",
            "sub: T, queue: 99999999999999999999",
            "rep: A -> B, max_size: 1B",
            "rep: A -> B, max_size: 0B",
            "pull: T, max_size: -1MiB",
            "req: A -> B, max_size: 1024MiB",
            "sub: T, max_size: 1025MiB",
            "sub: T, max_size: 99999999999999999999GiB",
            "req: A -> B, timeout: 0s",
            "req: A -> B, timeout: 1us",
            "req: A -> B, timeout: -1s",
            "req: A -> B, timeout: 86401s",
        ];
        let advice = |gate: &str| {
            advice(&format!("components:\n  - name: a\n    gates:\n      - x: {{{gate}, unconnected: ok}}\n"))
        };
        let told: String = gates.iter().map(|gate| format!("{gate}: {}\n", advice(gate))).collect();
        expect![[r#"
            sub: T, queue: 1: 
            sub: T, queue: -3: SCL0409 `queue` must be at least 1 [`queue: 1` keeps one message, and is the shortest queue | there is no unlimited `queue`; the largest is `queue: 1000000` | without it, the default is 100]
            sub: T, queue: 1000000: 
            sub: T, queue: 1000001: SCL0409 `queue` must be at most 1000000 [the largest is `queue: 1000000` | without it, the default is 100]
            sub: T, queue: 99999999999999999999: SCL0409 `queue` must be at most 1000000 [the largest is `queue: 1000000` | without it, the default is 100]
            rep: A -> B, max_size: 1B: 
            rep: A -> B, max_size: 0B: SCL0409 `max_size` must be at least 1B [there is no unlimited `max_size`; the largest is `max_size: 1GiB` | without it, the default is 64MiB]
            pull: T, max_size: -1MiB: SCL0409 `max_size` must be at least 1B [there is no unlimited `max_size`; the largest is `max_size: 1GiB` | without it, the default is 64MiB]
            req: A -> B, max_size: 1024MiB: 
            sub: T, max_size: 1025MiB: SCL0409 `max_size` must be at most 1GiB [the largest is `max_size: 1GiB` | without it, the default is 64MiB]
            sub: T, max_size: 99999999999999999999GiB: SCL0409 `max_size` must be at most 1GiB [the largest is `max_size: 1GiB` | without it, the default is 64MiB]
            req: A -> B, timeout: 0s: SCL0409 `timeout` must be more than 0 [there is no unlimited `timeout`; the largest is `timeout: 24h` | without it, the default is 1s]
            req: A -> B, timeout: 1us: 
            req: A -> B, timeout: -1s: SCL0409 `timeout` must be more than 0 [there is no unlimited `timeout`; the largest is `timeout: 24h` | without it, the default is 1s]
            req: A -> B, timeout: 86401s: SCL0409 `timeout` must be at most 24h [the largest is `timeout: 24h` | without it, the default is 1s]
        "#]].assert_eq(&told);
    }

    #[test]
    fn option_does_not_fit_the_kind() {
        rule_example(
            &MISFIT,
            expect![[r#"
            error: [SCL0408] option `queue` is not available on a `req` gate
             --> topology.yaml:4:44
              |
            4 |       - commands: {req: Command -> Status, queue: 8}
              |                                            ^^^^^
              |
              = help: remove it
              = note: a requester limits its unanswered calls with `in_flight` and `timeout`; `queue` is for `sub` and `pull`
        "#]],
        );
    }

    #[test]
    fn each_option_has_its_kinds() {
        let options =
            ["queue: 1", "when_full: wait", "backpressure: true", "max_size: 8MiB", "timeout: 1s", "share: true"];
        let kinds = ["pub: T", "sub: T", "req: A -> B", "rep: A -> B", "push: T", "pull: T"];
        let mut told = String::new();
        for (option, kind) in options.iter().flat_map(|option| kinds.map(|kind| (option, kind))) {
            let gate = format!("{{{kind}, {option}, unconnected: ok}}");
            let advice = advice(&format!("components:\n  - name: a\n    gates:\n      - x: {gate}\n"));
            if !advice.is_empty() {
                told.push_str(&format!("{advice}\n"));
            }
        }
        expect![[r#"
            SCL0408 option `queue` is not available on a `pub` gate [remove it | it belongs to the `sub` end of a connection]
            SCL0408 option `queue` is not available on a `req` gate [remove it]
            SCL0408 option `queue` is not available on a `rep` gate [remove it]
            SCL0408 option `queue` is not available on a `push` gate [remove it | it belongs to the `pull` end of a connection]
            SCL0408 option `when_full` is not available on a `pub` gate [remove it | it belongs to the `sub` end of a connection]
            SCL0408 option `when_full` is not available on a `req` gate [remove it]
            SCL0408 option `when_full` is not available on a `rep` gate [remove it]
            SCL0408 option `when_full` is not available on a `push` gate [remove it | it belongs to the `pull` end of a connection]
            SCL0408 option `backpressure` is not available on a `sub` gate [remove it | it belongs to the `pub` end of a connection]
            SCL0408 option `backpressure` is not available on a `req` gate [remove it]
            SCL0408 option `backpressure` is not available on a `rep` gate [remove it]
            SCL0408 option `backpressure` is not available on a `pull` gate [remove it | it belongs to the `push` end of a connection]
            SCL0408 option `max_size` is not available on a `pub` gate [remove it | it belongs to the `sub` end of a connection]
            SCL0408 option `max_size` is not available on a `push` gate [remove it | it belongs to the `pull` end of a connection]
            SCL0408 option `timeout` is not available on a `pub` gate [remove it]
            SCL0408 option `timeout` is not available on a `sub` gate [remove it]
            SCL0408 option `timeout` is not available on a `rep` gate [remove it | it belongs to the `req` end of a connection]
            SCL0408 option `timeout` is not available on a `push` gate [remove it]
            SCL0408 option `timeout` is not available on a `pull` gate [remove it]
            SCL0408 option `share` is not available on a `pub` gate [remove it]
            SCL0408 option `share` is not available on a `sub` gate [remove it]
            SCL0408 option `share` is not available on a `req` gate [remove it]
            SCL0408 option `share` is not available on a `rep` gate [remove it]
            SCL0408 option `share` is not available on a `pull` gate [remove it | it belongs to the `push` end of a connection]
        "#]].assert_eq(&told);
    }

    #[test]
    fn an_option_moves_to_the_ends_that_lack_it() {
        let advice = |sent: &str, one: &str, two: &str| {
            let gates = [("a", "pub", sent), ("b", "sub", one), ("c", "sub", two)].map(|(name, kind, option)| {
                format!("  - name: {name}\n    gates:\n      - x: {{{kind}: T{option}}}\n")
            });
            advice(&format!("components:\n{}connections:\n  - [a.x, b.x]\n  - [a.x, c.x]\n", gates.concat()))
        };
        let told = [
            advice(", queue: 9", "", ""),
            advice(", queue: 9", ", queue: 1", ""),
            advice(", queue_size: 9", ", queue: 1", ", queue: 2"),
            advice(", queue: many", "", ""),
        ];
        expect![[r#"
            SCL0408 option `queue` is not available on a `pub` gate [write `queue: 9` at `b.x`, `c.x` | remove it]
            SCL0408 option `queue` is not available on a `pub` gate [write `queue: 9` at `c.x`; `b.x` has its own | remove it]
            SCL0408 `queue_size` is called `queue` here, and is not available on a `pub` gate [remove it: `b.x`, `c.x` each have their own | it belongs to the `sub` end of a connection]
            SCL0408 option `queue` is not available on a `pub` gate [remove it]"#]].assert_eq(&told.join("\n"));
    }
}
