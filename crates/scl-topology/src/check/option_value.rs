//! SCL0409: an option value out of its range. Sets the options of every gate.

use super::draft::Draft;
use super::option_fit;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::grammar::{self, GateKind, GateOption, OutOfRange};
use crate::model::OptionModel;

/// SCL0409.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0409",
    severity: Severity::Error,
    title: "option value out of range",
    explanation: "The value is outside of what can work: a queue has room for at least one message, a timeout is more \
                  than nothing, and a message is held in memory as a whole. The message names the range; so does \
                  `scl explain queue`. Correct the value, or leave it out to get the default.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: Measurement, queue: 0}
+      - measurements: {sub: Measurement, queue: 1}
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    for gate in &mut draft.gates {
        for option in &gate.model.options {
            let Some(row) = grammar::option(&option.key.value) else { continue };
            // An option that the kind does not have has no effect, so nothing follows from it.
            let mut options = gate.options.clone();
            match row.set(&mut options, &option.value.value) {
                Ok(()) => match option_fit::check(gate.kind, option) {
                    Some(misfit) => problems.push(misfit),
                    None => gate.options = options,
                },
                Err(range) => problems.push(report(gate.kind, row, option, &range)),
            }
        }
    }
}

fn report(kind: Option<GateKind>, row: &GateOption, option: &OptionModel, range: &OutOfRange) -> Diagnostic {
    let headline = format!("`{}` must be {}", row.key, range.rule);
    let mut found = RULE.at(headline, option.value.span, "");
    if let Some(default) = row.default() {
        found = found.help(format!("leave it out to get the default, {default}"));
    }
    if let Some(reason) = range.reason {
        found = found.note(reason);
    }
    // An option that this kind of gate does not have needs no other value.
    match option_fit::misfit(kind, row.key) {
        Some(rule) => found.note(rule),
        None => found,
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn option_value_out_of_range() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0409] `queue` must be at least 1
             --> topology.yaml:4:49
              |
            4 |       - measurements: {pub: Measurement, queue: 0}
              |                                                 ^
              |
              = help: leave it out to get the default, 100
              = note: each receiver says how many messages may wait for it; `queue` is for `sub` and `pull`
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
            sub: T, queue: -3: SCL0409 `queue` must be at least 1 [leave it out to get the default, 100]
            sub: T, queue: 1000000: 
            sub: T, queue: 1000001: SCL0409 `queue` must be at most 1000000 [leave it out to get the default, 100]
            sub: T, queue: 99999999999999999999: SCL0409 `queue` must be at most 1000000 [leave it out to get the default, 100]
            rep: A -> B, max_size: 1B: 
            rep: A -> B, max_size: 0B: SCL0409 `max_size` must be at least 1B [leave it out to get the default, 64MiB]
            pull: T, max_size: -1MiB: SCL0409 `max_size` must be at least 1B [leave it out to get the default, 64MiB]
            req: A -> B, max_size: 1024MiB: 
            sub: T, max_size: 1025MiB: SCL0409 `max_size` must be at most 1GiB [leave it out to get the default, 64MiB]
            sub: T, max_size: 99999999999999999999GiB: SCL0409 `max_size` must be at most 1GiB [leave it out to get the default, 64MiB]
            req: A -> B, timeout: 0s: SCL0409 `timeout` must be more than 0 [leave it out to get the default, 1s]
            req: A -> B, timeout: 1us: 
            req: A -> B, timeout: -1s: SCL0409 `timeout` must be more than 0 [leave it out to get the default, 1s]
            req: A -> B, timeout: 86401s: SCL0409 `timeout` must be at most 86400s [leave it out to get the default, 1s]
        "#]].assert_eq(&told);
    }
}
