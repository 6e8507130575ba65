//! SCL0408: an option on a kind of gate that has no use for it.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::grammar;
use crate::model::OptionModel;
use crate::topology::GateKind;
use crate::wording::all_of;

/// SCL0408.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0408",
    severity: Severity::Error,
    title: "option does not fit the kind",
    explanation: "The option exists, but not for this kind of gate: `queue` and `max_size` belong to the receiving end, \
                  `timeout` to the asking one. Move it to the other end, or remove it.",
    example: " components:
   - name: ui
     gates:
-      - commands: {req: Command -> Status, queue: 8}
+      - commands: {req: Command -> Status, timeout: 1s, unconnected: ok}
",
};

/// The problem of an option that this kind of gate does not have.
pub(super) fn check(kind: Option<GateKind>, option: &OptionModel) -> Option<Diagnostic> {
    let key = option.key.value.as_str();
    let kind = kind?;
    let rule = misfit(Some(kind), key)?;
    let headline = format!("option `{key}` is not available on a `{}` gate", kind.word());
    let found = RULE.at(headline, option.key.span, "").help("remove it");
    let other = kind.opposite();
    let found = match fits(other, key) {
        true => found.help(format!("or write it at the `{}` end of the connection", other.word())),
        false => found,
    };
    Some(found.note(rule))
}

/// Why a kind has no such option, if it has none.
pub(super) fn misfit(kind: Option<GateKind>, key: &str) -> Option<String> {
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
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn option_does_not_fit_the_kind() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0408] option `queue` is not available on a `req` gate
             --> topology.yaml:4:44
              |
            4 |       - commands: {req: Command -> Status, queue: 8}
              |                                            ^^^^^
              |
              = help: remove it
              = note: `req` and `rep` take turns, so there is never more than one message waiting; `queue` is for `sub` and `pull`
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
