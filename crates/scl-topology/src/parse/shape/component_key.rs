//! SCL0207: an unknown key in a component.

use super::{own_key, suggest, ticked};
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::{Field, Fields};
use crate::parse::scalar;
use crate::parse::words::COMPONENT_KEYS;
use crate::suggest::similar;

/// SCL0207.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0207",
    severity: Severity::Error,
    title: "unknown key in a component",
    explanation: "A component has the keys `name`, `gates`, `doc` and `optional`. Another one is mostly misspelt, and \
                  would be ignored silently otherwise. Correct or remove it.",
    example: " components:
   - name: sensor
-    gate:
+    gates:
       - measurements: pub
",
};

pub(in crate::parse) fn diagnose(field: Field<'_>, component: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in component `{component}`", field.key);
    let problem = RULE.at(message, field.key_span, "not a key of a component");
    let problem = own_key(problem, field.key);
    suggest(problem, "key", field.key, COMPONENT_KEYS).note(format!("keys of a component: {}", ticked(COMPONENT_KEYS)))
}

/// Words that other formats use for a name.
const OTHER_WORDS: [&str; 6] = ["id", "component", "node", "title", "label", "process"];

/// Whether a key was probably meant to be `name`.
pub(in crate::parse) fn is_misnamed(key: &str) -> bool {
    let is_near = !COMPONENT_KEYS.contains(&key) && similar(key, COMPONENT_KEYS).first() == Some(&"name");
    is_near || OTHER_WORDS.contains(&key)
}

/// The key that was probably meant to be `name`.
pub(in crate::parse) fn misnamed<'n>(fields: &Fields<'n>) -> Option<Field<'n>> {
    fields.list.iter().copied().find(|field| is_misnamed(field.key) && scalar(field.value).is_some())
}

/// A key in the place of `name`.
pub(in crate::parse) fn instead_of_name(field: Field<'_>) -> Diagnostic {
    let name = scalar(field.value).map_or(String::new(), |name| name.value);
    let problem = RULE.at(format!("unknown key `{}` in a component", field.key), field.key_span, "expected `name`");
    match OTHER_WORDS.contains(&field.key) {
        true => problem.help(format!("write `name: {name}`")),
        false => problem.help("a key with a similar name exists: `name`").fix(field.key_span, "name"),
    }
    .note(format!("keys of a component: {}", ticked(COMPONENT_KEYS)))
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
            error: [SCL0207] unknown key `gate` in component `sensor`
             --> topology.yaml:3:5
              |
            3 |     gate:
              |     ^^^^ not a key of a component
              |
              = help: a key with a similar name exists: `gates`
              = note: keys of a component: `name`, `gates`, `doc`, `optional`"#]],
        );
    }
}
