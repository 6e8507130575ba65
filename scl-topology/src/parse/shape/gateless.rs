//! SCL0209: a component without gates.

use crate::diagnostic::Diagnostic;
use crate::parse::fields::Field;
use crate::source::Spanned;

/// A warning where `gates` is missing or has no value; `gates: []` is meant.
pub(in crate::parse) fn find(component: &Spanned<String>, gates: Option<Field<'_>>) -> Option<Diagnostic> {
    if gates.is_some_and(|field| !field.value.is_null()) {
        return None;
    }
    let message = format!("component `{}` has no gates", component.value);
    let mut problem = Diagnostic::warning("SCL0209", message, component.span, "it cannot be part of any connection");
    if let Some(gates) = gates {
        let span = crate::source::Span { end: gates.key_span.end + 1, ..gates.key_span };
        problem = problem.label(span, "empty");
    }
    Some(problem.help("add a gate, or remove the component").help("if it is meant, write `gates: []`"))
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - name: logger
    gates:
";

    #[test]
    fn example() {
        check(
            "SCL0209",
            EXAMPLE,
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
