//! SCL0401: a word that is no kind of gate. Sets the kind of every other gate.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::grammar::{PATTERNS, Pattern};
use crate::habits;
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
        let word = &gate.model.kind;
        gate.kind = GateKind::of(&word.value);
        // An empty word stands for a gate that could not be read, which has its own problem.
        if gate.kind.is_none() && !word.value.is_empty() {
            problems.push(report(word, draft.sources));
        }
    }
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

fn report(word: &Spanned<String>, sources: &Sources) -> Diagnostic {
    let found = RULE.at(format!("unknown gate kind `{}`", word.value), word.span, "");
    let meant = suggest::kind(&word.value);
    let lead = if meant.len() == 1 { ("the kind is called ", "") } else { ("did you mean ", "?") };
    let rewritten = |kind: &str| Edit::new(word.span, sources.quoted_as(word.span, kind));
    let habit = habits::of_key(habits::KINDS, &word.value);
    let nearest = habit.and_then(|habit| habit.ways.first());
    let found = found.choose(lead, meant.iter().map(|kind| (*kind, rewritten(kind))));
    let found = nearest
        .iter()
        .fold(found, |found, kind| found.suggest(format!("the nearest kind is `{kind}`"), [rewritten(kind)]));
    found.helps(habit.map(|habit| habit.text)).note(kinds())
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
