//! SCL0408: an option on a kind of gate that has no use for it. SCL0409: an option value out of its range. Sets the
//! options of every gate.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::grammar::{self, GateKind, GateOption, OutOfRange};
use crate::model::OptionModel;
use scl_text::list::all_of;

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
                Ok(()) => match check_fit(gate.kind, option) {
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
    let default = row.default().map(|default| format!("leave it out to get the default, {default}"));
    let found = VALUE.at(headline, option.value.span, "").helps(default).notes(range.reason);
    // If this kind of gate does not have the option, say so: no value would be right.
    found.notes(misfit(kind, row.key))
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

/// The problem of an option that this kind of gate does not have.
fn check_fit(kind: Option<GateKind>, option: &OptionModel) -> Option<Diagnostic> {
    let key = option.key.value.as_str();
    let kind = kind?;
    let rule = misfit(Some(kind), key)?;
    let headline = format!("option `{key}` is not available on a `{}` gate", kind.word());
    let other = Some(kind.opposite()).filter(|&other| fits(other, key));
    let at_other_end = other.map(|other| format!("or write it at the `{}` end of the connection", other.word()));
    Some(MISFIT.at(headline, option.key.span, "").help("remove it").helps(at_other_end).note(rule))
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
            SCL0408 option `queue` is not available on a `pub` gate [remove it | or write it at the `sub` end of the connection]
            SCL0408 option `queue` is not available on a `req` gate [remove it]
            SCL0408 option `queue` is not available on a `rep` gate [remove it]
            SCL0408 option `queue` is not available on a `push` gate [remove it | or write it at the `pull` end of the connection]
            SCL0408 option `when_full` is not available on a `pub` gate [remove it | or write it at the `sub` end of the connection]
            SCL0408 option `when_full` is not available on a `req` gate [remove it]
            SCL0408 option `when_full` is not available on a `rep` gate [remove it]
            SCL0408 option `when_full` is not available on a `push` gate [remove it | or write it at the `pull` end of the connection]
            SCL0408 option `backpressure` is not available on a `sub` gate [remove it | or write it at the `pub` end of the connection]
            SCL0408 option `backpressure` is not available on a `req` gate [remove it]
            SCL0408 option `backpressure` is not available on a `rep` gate [remove it]
            SCL0408 option `backpressure` is not available on a `pull` gate [remove it | or write it at the `push` end of the connection]
            SCL0408 option `max_size` is not available on a `pub` gate [remove it | or write it at the `sub` end of the connection]
            SCL0408 option `max_size` is not available on a `push` gate [remove it | or write it at the `pull` end of the connection]
            SCL0408 option `timeout` is not available on a `pub` gate [remove it]
            SCL0408 option `timeout` is not available on a `sub` gate [remove it]
            SCL0408 option `timeout` is not available on a `rep` gate [remove it | or write it at the `req` end of the connection]
            SCL0408 option `timeout` is not available on a `push` gate [remove it]
            SCL0408 option `timeout` is not available on a `pull` gate [remove it]
            SCL0408 option `share` is not available on a `pub` gate [remove it]
            SCL0408 option `share` is not available on a `sub` gate [remove it]
            SCL0408 option `share` is not available on a `req` gate [remove it]
            SCL0408 option `share` is not available on a `rep` gate [remove it]
            SCL0408 option `share` is not available on a `pull` gate [remove it | or write it at the `push` end of the connection]
        "#]].assert_eq(&told);
    }
}
