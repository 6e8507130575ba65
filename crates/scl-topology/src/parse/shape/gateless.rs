//! SCL0209: a component without gates.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::Field;
use crate::source::Spanned;

/// SCL0209.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0209",
    severity: Severity::Warning,
    title: "component without gates",
    explanation: "A component without gates can talk to nobody, so it is probably not finished. Add a gate, or remove \
                  the component; `gates: []` says that it is meant.",
    example: " components:
   - name: logger
-    gates:
+    gates: []
",
};

/// A warning where `gates` is missing or has no value; `gates: []` is meant.
pub(in crate::parse) fn find(component: &Spanned<String>, gates: Option<Field<'_>>) -> Option<Diagnostic> {
    if gates.is_some_and(|field| !field.value.is_null()) {
        return None;
    }
    let message = format!("component `{}` has no gates", component.value);
    let mut problem = RULE.at(message, component.span, "it cannot be part of any connection");
    if let Some(gates) = gates {
        let span = crate::source::Span { end: gates.key_span.end + 1, ..gates.key_span };
        problem = problem.label(span, "empty");
    }
    Some(problem.help("add a gate, or remove the component").help("if it is meant, write `gates: []`"))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            warning: [SCL0209] component `logger` has no gates
             --> topology.yaml:2:11
              |
            2 |   - name: logger
              |           ^^^^^^ it cannot be part of any connection
            3 |     gates:
              |     ------ empty
              |
              = help: add a gate, or remove the component
              = help: if it is meant, write `gates: []`"#]],
        );
    }
}
