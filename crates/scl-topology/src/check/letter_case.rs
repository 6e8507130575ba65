//! SCL0310: names that only letter case and `_` tell apart. People mix them up, and so do some file systems.

use super::named::is_well_formed;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::rust_name::{component_type, gate_field};
use crate::source::Spanned;
use std::collections::HashMap;

/// SCL0310.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0310",
    severity: Severity::Warning,
    title: "names that differ only in letter case",
    explanation: "Two names differ only in capitals, `_` or `-`. People mix them up, a language that writes names in \
                  another case makes one name of them, and on file systems that ignore case their socket files would \
                  be one. Rename one.",
    example: " components:
   - name: gps
     gates: []
-  - name: GPS_
+  - name: receiver
     gates: []
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    let components = model.components.iter().map(|component| &component.name);
    check_names("components", components, component_type, problems);
    for component in &model.components {
        check_names("gates", component.gates.iter().map(|gate| &gate.name), gate_field, problems);
    }
}

fn check_names<'m>(
    plural: &str,
    names: impl Iterator<Item = &'m Spanned<String>>,
    rust: fn(&str) -> String,
    problems: &mut Diagnostics,
) {
    let mut first: HashMap<String, &Spanned<String>> = HashMap::new();
    for name in names.filter(|name| is_well_formed(&name.value)) {
        let other = *first.entry(folded(&name.value)).or_insert(name);
        // Names that are one in Rust are an error already.
        if rust(&other.value) != rust(&name.value) {
            problems.push(report(plural, other, name));
        }
    }
}

fn folded(name: &str) -> String {
    name.chars().filter(|&letter| letter != '_' && letter != '-').map(|letter| letter.to_ascii_lowercase()).collect()
}

fn report(plural: &str, first: &Spanned<String>, second: &Spanned<String>) -> Diagnostic {
    let headline = format!("{plural} `{}` and `{}` differ only in letter case and `_`", first.value, second.value);
    RULE.at(headline, second.span, "")
        .label(first.span, "")
        .help("rename one of them")
        .note("their socket files would be the same on a file system that ignores case (macOS, Windows)")
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn names_that_differ_only_in_letter_case() {
        rule_example(
            &RULE,
            expect![[r#"
            warning: [SCL0310] components `gps` and `GPS_` differ only in letter case and `_`
             --> topology.yaml:4:11
              |
            2 |   - name: gps
              |           ---
            3 |     gates: []
            4 |   - name: GPS_
              |           ^^^^
              |
              = help: rename one of them
              = note: their socket files would be the same on a file system that ignores case (macOS, Windows)
        "#]],
        );
    }
}
