//! SCL0505: both ends send, or both receive. SCL0506: the ends belong to different patterns. Finds source and sink of
//! every other connection.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::topology::GateKind;

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
    for link in 0..draft.links.len() {
        let [Some(a), Some(b)] = draft.links[link].ends else { continue };
        let (Some(kind_a), Some(kind_b)) = (draft.gates[a].kind, draft.gates[b].kind) else { continue };
        if a == b {
            continue;
        }
        if kind_a.opposite() == kind_b {
            draft.links[link].flow = Some(if kind_a.is_source() { (a, b) } else { (b, a) });
        } else if kind_a == kind_b {
            problems.push(same_direction(draft, link, [a, b], kind_a));
        } else {
            problems.push(different_patterns(draft, link, [a, b], [kind_a, kind_b]));
        }
    }
}

fn same_direction(draft: &Draft<'_>, link: usize, [a, b]: [usize; 2], kind: GateKind) -> Diagnostic {
    let (both, one, nobody) = match kind {
        GateKind::Pub => ("publish", "sends", "nobody receives"),
        GateKind::Sub => ("subscribe", "receives", "nobody sends"),
        GateKind::Req => ("ask", "asks", "nobody answers"),
        GateKind::Rep => ("answer", "answers", "nobody asks"),
        GateKind::Push => ("push", "sends", "nobody receives"),
        GateKind::Pull => ("pull", "receives", "nobody sends"),
    };
    let wanted = kind.opposite();
    let (word, other) = (kind.word(), wanted.word());
    let headline = format!("both ends of this connection {both}");
    let fitting = [fitting(draft, a, b), fitting(draft, b, a)];
    let found = SAME_DIRECTION
        .at(headline, draft.links[link].model.span, nobody)
        .label(draft.gates[a].model.kind.span, one)
        .label(draft.gates[b].model.kind.span, format!("{one} too"))
        .help(format!("a `{word}` gate connects to a `{other}` gate; should one of the two be `{other}`?"))
        .helps(fitting.iter().flatten());
    match fitting {
        [None, None] => found.note(nobody_is(draft, [a, b], other)),
        _ => found,
    }
}

fn nobody_is(draft: &Draft<'_>, [a, b]: [usize; 2], kind: &str) -> String {
    let (a, b) = (draft.component_name(a), draft.component_name(b));
    match a == b {
        true => format!("no gate of `{a}` is a `{kind}`"),
        false => format!("no gate of `{a}` or `{b}` is a `{kind}`"),
    }
}

fn different_patterns(draft: &Draft<'_>, link: usize, [a, b]: [usize; 2], kinds: [GateKind; 2]) -> Diagnostic {
    let [a_word, b_word] = kinds.map(GateKind::word);
    let headline = format!("a `{a_word}` gate cannot be connected to a `{b_word}` gate");
    OTHER_PATTERN
        .at(headline, draft.links[link].model.span, "")
        .label(draft.gates[a].model.span, doing(kinds[0]))
        .label(draft.gates[b].model.span, doing(kinds[1]))
        // The end with an obvious partner comes first.
        .helps([fitting(draft, b, a), fitting(draft, a, b)].into_iter().flatten())
        .note("pairs that fit: pub - sub, req - rep, push - pull")
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

/// What `gate` could be connected to in the component of `other`: the gate of its own name, else the only one that
/// fits.
fn fitting(draft: &Draft<'_>, gate: usize, other: usize) -> Option<String> {
    let wanted = draft.gates[gate].kind?.opposite();
    let fits: Vec<usize> = draft
        .gates_of(draft.component_name(other))
        .filter(|&at| at != gate && at != other && draft.gates[at].kind == Some(wanted))
        .collect();
    let name = &draft.gates[gate].model.name.value;
    let namesake = fits.iter().find(|&&at| draft.gates[at].model.name.value == *name);
    let best = namesake.or(if fits.len() == 1 { fits.first() } else { None })?;
    Some(format!("`{}` fits {}", draft.path(gate), draft.path_and_kind(*best)))
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
              = help: a `pub` gate connects to a `sub` gate; should one of the two be `sub`?
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
               = help: `ui.commands` fits `controller.commands` (rep)
               = help: `controller.events` fits `ui.events` (sub)
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
               = help: a `pub` gate connects to a `sub` gate; should one of the two be `sub`?
               = help: `gps.fix` fits `pilot.fix` (sub)
        "#]],
        );
    }
}
