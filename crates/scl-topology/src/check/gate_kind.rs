//! SCL0401: a word that is no kind of gate. Sets the kind of every other gate.

use super::draft::{Draft, DraftGate};
use super::unconnected::new_connection;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::grammar::{PATTERNS, Pattern};
use crate::habits;
use crate::model::GateModel;
use crate::source::{Sources, Spanned};
use crate::suggest;
use crate::topology::GateKind;

/// SCL0401.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0401",
    severity: Severity::Error,
    title: "unknown gate kind",
    explanation: "This word is not a kind of gate. The kinds come in pairs: `pub` and `sub`, `req` and `rep`, `push` \
                  and `pull`. If the word is used by other frameworks, the message names the kind that it stands for.",
    example: " components:
   - name: controller
     gates:
-      - sensor: subscribe
+      - sensor: sub
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    for gate in &mut draft.gates {
        gate.kind = GateKind::of(&gate.model.kind.value);
    }
    // An empty word stands for a gate that could not be read, which has its own problem.
    let is_unknown = |gate: &DraftGate<'_>| gate.kind.is_none() && !gate.model.kind.value.is_empty();
    let unknown = draft.gates.iter().enumerate().filter(|(_, gate)| is_unknown(gate));
    problems.extend(unknown.map(|(at, gate)| match as_connection(draft, at) {
        Some((help, edits)) => headline(&gate.model.kind).suggest(help, edits).note(kinds()),
        None => report(gate.model, draft.sources),
    }));
    poison_contradictions(draft);
}

/// Clears the type of each gate that is declared twice, and its kind too if the two kinds differ, as it is unknown
/// which declaration is meant.
fn poison_contradictions(draft: &mut Draft<'_>) {
    for at in 0..draft.gates.len() {
        if !draft.gates[at].duplicate {
            continue;
        }
        let name = draft.gates[at].model.name.value.as_str();
        if let Some(first) = draft.gate(draft.component_name(at), name) {
            if draft.gates[first].kind != draft.gates[at].kind {
                draft.gates[first].kind = None;
            }
            draft.gates[first].payload = None;
        }
    }
}

/// The kinds in pairs, each pair with what it is for.
fn kinds() -> String {
    let pair = |pattern: &Pattern| {
        let ends = [pattern.source.word(), pattern.source.opposite().word()];
        format!("{} ({})", scl_text::list::all_of(&ends), pattern.summary)
    };
    format!("kinds: {}", PATTERNS.iter().map(pair).collect::<Vec<_>>().join(", "))
}

/// `image: camera/image`, where the gate to which this one is to be connected stands in the place of the kind.
fn as_connection(draft: &Draft<'_>, gate: usize) -> Option<(String, [Edit; 2])> {
    let model = draft.gates[gate].model;
    let (component, name) = model.kind.value.split_once(['/', '.'])?;
    let other = draft.gate(component, name).filter(|_| model.payload.is_none())?;
    let kind = draft.gates[other].kind?.opposite().word();
    let written = match &draft.gates[other].model.payload {
        Some(payload) => format!("{{{kind}: {}}}", payload.value.trim()),
        None => kind.to_owned(),
    };
    let pair = format!("[{}, {}]", draft.path(other), draft.path(gate));
    let added = new_connection(draft, &pair)?;
    let help = format!("write `{}: {written}`, and add the connection `{pair}`", model.name.value);
    Some((help, [Edit::new(model.kind.span, written), added]))
}

fn headline(word: &Spanned<String>) -> Diagnostic {
    RULE.at(format!("unknown gate kind `{}`", word.value), word.span, "")
}

fn report(gate: &GateModel, sources: &Sources) -> Diagnostic {
    let word = &gate.kind;
    let found = headline(word);
    let meant = suggest::kind(&word.value);
    let lead = if meant.len() == 1 { ("the kind is called ", "") } else { ("did you mean ", "?") };
    let rewritten = |kind: &str| Edit::new(word.span, sources.quoted_as(word.span, kind));
    let habit = habits::KINDS.find(&word.value);
    let nearest = habit.and_then(|habit| habit.ways.first());
    let found = found.choose(lead, meant.iter().map(|kind| (*kind, rewritten(kind))));
    let found = nearest
        .iter()
        .fold(found, |found, kind| found.suggest(format!("the nearest kind is `{kind}`"), [rewritten(kind)]));
    // Two types are those of a request and its reply.
    let is_exchange = gate.payload.as_ref().is_some_and(|payload| payload.value.contains("->"));
    let asking = ["req", "rep"].into_iter().filter(|kind| is_exchange && meant.is_empty() && nearest != Some(kind));
    let found = asking.fold(found, |found, kind| {
        found.suggest(format!("two types are those of a request and its reply: write `{kind}`"), [rewritten(kind)])
    });
    match is_exchange {
        true => found.note(kinds()),
        false => found.helps(habit.map(|habit| habit.text)).note(kinds()),
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn unknown_gate_kind() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0401] unknown gate kind `subscribe`
             --> topology.yaml:4:17
              |
            4 |       - sensor: subscribe
              |                 ^^^^^^^^^
              |
              = help: the kind is called `sub`
              = note: kinds: `pub` and `sub` (one to many, no answer), `req` and `rep` (question and answer), `push` and `pull` (many to one, no answer)
        "#]],
        );
    }
}
