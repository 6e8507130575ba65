//! SCL0306: a gate whose field needs `r#`. SCL0307: a name that not even `r#` makes usable.

use super::named::{Noun, is_well_formed, names};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::rust_name::{component_type, gate_field, is_keyword, is_unescapable};
use crate::source::Spanned;

/// SCL0306.
pub(crate) const KEYWORD: Rule = Rule {
    code: "SCL0306",
    severity: Severity::Warning,
    title: "gate name is a Rust keyword",
    explanation: "The name is a keyword of Rust, so programs have to write `r#` before it. That works, but is \
                  hard to read. Choose a name that says more.",
    example: " components:
   - name: sensor
     gates:
-      - type: pub
+      - model: pub
",
};

/// SCL0307.
pub(crate) const HARD_KEYWORD: Rule = Rule {
    code: "SCL0307",
    severity: Severity::Error,
    title: "keyword that cannot be escaped",
    explanation: "The name is one of the few keywords that not even `r#` makes usable, so no Rust program could name \
                  the gate or component. Choose another.",
    example: " components:
-  - name: crate
+  - name: box_of_parts
+    gates: []
",
};

/// Other words for the keywords that name a thing in a real system.
const ALTERNATIVES: [(&str, &str); 12] = [
    ("type", "kind"),
    ("loop", "cycle"),
    ("move", "motion"),
    ("match", "hit"),
    ("ref", "reference"),
    ("abstract", "summary"),
    ("final", "last"),
    ("static", "fixed"),
    ("use", "usage"),
    ("in", "input"),
    ("box", "bounds"),
    ("override", "manual"),
];

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model).filter(|(noun, _)| *noun != Noun::System) {
        if is_unusable(noun, &name.value) {
            problems.push(unusable(noun, name));
        }
    }
    for component in &model.components {
        for gate in component.gates.iter().filter(|gate| is_well_formed(&gate.name.value)) {
            if is_keyword(&gate_field(&gate.name.value)) {
                problems.push(escaped(&component.name.value, &gate.name));
            }
        }
    }
}

/// Whether the name, or the Rust name that is made of it, cannot be a name even with `r#`. Names that start with `__` are
/// reserved, which is another rule.
fn is_unusable(noun: Noun, name: &str) -> bool {
    !name.starts_with("__") && (is_unescapable(name) || is_well_formed(name) && is_unescapable(&rust_name(noun, name)))
}

fn rust_name(noun: Noun, name: &str) -> String {
    if noun == Noun::Component { component_type(name) } else { gate_field(name) }
}

fn unusable(noun: Noun, name: &Spanned<String>) -> Diagnostic {
    let word = &name.value;
    let rust = rust_name(noun, word);
    let becomes = if noun == Noun::Component { "type" } else { "field" };
    let headline = match word.as_str() {
        "_" => "`_` is not a name in Rust".to_owned(),
        _ if is_unescapable(word) => {
            format!("`{word}` is a Rust keyword that cannot be used as a name, not even as `r#{word}`")
        }
        _ => format!("{} name `{word}` becomes the Rust {becomes} `{rust}`, which is a keyword", noun.word()),
    };
    let others: Vec<&str> = ["crate", "self", "Self", "super", "_"].into_iter().filter(|other| other != word).collect();
    HARD_KEYWORD
        .at(headline, name.span, "")
        .help("choose another name")
        .note(format!("not usable either: {}", crate::wording::listed(others)))
}

fn escaped(component: &str, name: &Spanned<String>) -> Diagnostic {
    let field = gate_field(&name.value);
    let label = format!("in Rust code you will have to write `{}.r#{field}`", gate_field(component));
    let help = match ALTERNATIVES.iter().find(|(word, _)| *word == field) {
        Some((_, other)) => format!("choose another name, for example `{other}`"),
        None => format!("choose another name, for example `{field}_`"),
    };
    KEYWORD.at(format!("gate name `{}` is a Rust keyword", name.value), name.span, label).help(help).note(
        "checked against the keywords of editions 2015 to 2024 and the reserved ones (`gen`, `try`, `yield`, ...)",
    )
}

#[cfg(test)]
mod tests {
    use super::{HARD_KEYWORD, KEYWORD};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn gate_name_is_a_rust_keyword() {
        rule_example(
            &KEYWORD,
            expect![[r#"
            warning: [SCL0306] gate name `type` is a Rust keyword
             --> topology.yaml:4:9
              |
            4 |       - type: pub
              |         ^^^^ in Rust code you will have to write `sensor.r#type`
              |
              = help: choose another name, for example `kind`
              = note: checked against the keywords of editions 2015 to 2024 and the reserved ones (`gen`, `try`, `yield`, ...)
        "#]],
        );
    }

    #[test]
    fn keyword_that_cannot_be_escaped() {
        rule_example(
            &HARD_KEYWORD,
            expect![[r#"
                error: [SCL0307] `crate` is a Rust keyword that cannot be used as a name, not even as `r#crate`
                 --> topology.yaml:2:11
                  |
                2 |   - name: crate
                  |           ^^^^^
                  |
                  = help: choose another name
                  = note: not usable either: `self`, `Self`, `super`, `_`
            "#]],
        );
    }
}
