//! SCL0128: a number with a leading zero, which YAML 1.1 reads as octal.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::field::Field;

/// SCL0128.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0128",
    severity: Severity::Error,
    title: "number with a leading zero",
    explanation: "YAML 1.2 reads `010` as 10, older YAML tools such as PyYAML read it as the octal number 8, and `08` as \
                  text. A topology file is read by programs in several languages, so its numbers must mean the same \
                  in all of them. Write the number without the zero.",
    example: " components:
   - name: controller
     gates:
-      - sensor: {sub: Measurement, queue: 010}
+      - sensor: {sub: Measurement, queue: 10}
",
};

/// Checks a whole number that is written without quotes.
pub(in crate::parse) fn find(field: Field<'_>, text: &str) -> Option<Diagnostic> {
    let digits = text.trim_start_matches(['-', '+']);
    let decimal = digits.trim_start_matches('0');
    if digits.len() < 2 || decimal.len() == digits.len() {
        return None;
    }
    let key = field.key;
    let sign = if text.starts_with('-') { "-" } else { "" };
    let decimal = format!("{sign}{}", if decimal.is_empty() { "0" } else { decimal });
    let label = match u64::from_str_radix(digits, 8) {
        Ok(octal) => format!("YAML 1.1 tools such as PyYAML read this as {octal}"),
        Err(_) => "YAML 1.1 tools such as PyYAML read this as text or as another number".to_owned(),
    };
    Some(
        RULE.at(format!("`{key}` has a leading zero: `{text}`"), field.value.span, label)
            .suggest(format!("write `{key}: {decimal}`"), [Edit::new(field.value.span, decimal)])
            .note("a topology file is read by bindings in several languages, so it must mean the same in YAML 1.1 and 1.2"),
    )
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::{check, headlines};
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0128] `queue` has a leading zero: `010`
             --> topology.yaml:4:43
              |
            4 |       - sensor: {sub: Measurement, queue: 010}
              |                                           ^^^ YAML 1.1 tools such as PyYAML read this as 8
              |
              = help: write `queue: 10`
              = note: a topology file is read by bindings in several languages, so it must mean the same in YAML 1.1 and 1.2"#]],
        );
    }

    #[test]
    fn zeros_in_other_places_are_fine() {
        let told = ["0", "10", "100", "00", "+07", "-08", "0"].map(|number| {
            headlines(&format!(
                "components: [{{name: a, gates: [{{x: {{sub: T, queue: {number}}}}}]}}]\nconnections: []\n"
            ))
        });
        expect![[r#"
            SCL0128 1:52 `queue` has a leading zero: `00`
            SCL0128 1:52 `queue` has a leading zero: `+07`
            SCL0128 1:52 `queue` has a leading zero: `-08`
        "#]]
        .assert_eq(&told.concat());
    }
}
