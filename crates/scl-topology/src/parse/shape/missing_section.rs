//! SCL0203: the section `components` is missing.

use super::ticked;
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::Fields;
use crate::source::SourceFile;

/// SCL0203.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0203",
    severity: Severity::Error,
    title: "required section missing",
    explanation: "The section `components` declares who may talk at all; without it nothing else has a meaning. Add \
                  it.",
    example: "-connections:
-  - [sensor.measurements, controller.sensor]
+components: []
+connections: []
",
};

pub(in crate::parse) fn diagnose(fields: &Fields<'_>, source: &SourceFile) -> Diagnostic {
    const MESSAGE: &str = "the section `components` is missing";
    const SHOWN: usize = 6;
    let keys: Vec<&str> = fields.list.iter().map(|field| field.key).collect();
    let first = fields.list.first().map_or(source.span(0..0), |field| field.key_span);
    let label = match keys.len() {
        0 => "this file has no section".to_owned(),
        count if count > SHOWN => {
            format!("this file has only {} and {} more", ticked(keys[..SHOWN].iter().copied()), count - SHOWN)
        }
        _ => format!("this file has only {}", ticked(keys)),
    };
    RULE.at(MESSAGE, first, label).help("add the section; it declares each component and its gates")
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
            error: [SCL0203] the section `components` is missing
             --> topology.yaml:1:1
              |
            1 | connections:
              | ^^^^^^^^^^^ this file has only `connections`
              |
              = help: add the section; it declares each component and its gates"#]],
        );
    }
}
