//! Names that a language reserves. SCL0306: a gate whose field needs `r#`. SCL0307: a name that not even `r#` makes
//! usable. SCL0315: a keyword of C++ or Python: the same file is read by programs in these languages.

use super::named::{Noun, names};
use super::rename::Renames;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::keywords::{is_cpp, is_python};
use crate::model::Model;
use crate::rust_name::{component_type, gate_field, is_keyword, is_unescapable};
use crate::source::Spanned;
use crate::spelling::is_well_formed;
use scl_text::list::all_of;

/// SCL0306.
pub(crate) const OF_RUST: Rule = Rule {
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
pub(crate) const UNUSABLE: Rule = Rule {
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

/// Replacements for keywords that are plausible names in a real system.
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

pub(super) fn check<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    check_foreign(model, renames, problems);
    for (noun, name) in names(model).filter(|(noun, _)| *noun != Noun::System) {
        if is_unusable(noun, &name.value) {
            problems.push(unusable(noun, name));
        }
    }
    for owner in model.owners() {
        for gate in owner.gates.iter().filter(|gate| is_well_formed(&gate.name.value)) {
            if is_keyword(&gate_field(&gate.name.value)) {
                problems.push(escaped(renames, &owner.name.value, &gate.name));
            }
        }
    }
}

/// Whether the name, or the Rust name that is made of it, cannot be a name even with `r#`. Names that start with `__`
/// are reserved, which is another rule.
fn is_unusable(noun: Noun, name: &str) -> bool {
    !name.starts_with("__")
        && (is_unescapable(name) || noun.is_well_formed(name) && is_unescapable(&rust_name(noun, name)))
}

fn rust_name(noun: Noun, name: &str) -> String {
    if noun.is_type() { component_type(name) } else { gate_field(name) }
}

fn unusable(noun: Noun, name: &Spanned<String>) -> Diagnostic {
    let word = &name.value;
    let rust = rust_name(noun, word);
    let becomes = if noun.is_type() { "type" } else { "field" };
    let headline = match word.as_str() {
        "_" => "`_` is not a name in Rust".to_owned(),
        _ if is_unescapable(word) => {
            format!("`{word}` is a Rust keyword that cannot be used as a name, not even as `r#{word}`")
        }
        _ => format!("{} name `{word}` becomes the Rust {becomes} `{rust}`, which is a keyword", noun.word()),
    };
    let others: Vec<&str> = ["crate", "self", "Self", "super", "_"].into_iter().filter(|other| other != word).collect();
    UNUSABLE
        .at(headline, name.span, "")
        .help("the name is any other word of letters, digits, `_` and `-`")
        .note(format!("not usable either: {}", scl_text::list::listed(others)))
}

fn escaped<'m>(renames: &Renames<'m>, owner: &str, name: &'m Spanned<String>) -> Diagnostic {
    let field = gate_field(&name.value);
    let label = format!("in Rust code you will have to write `{}.r#{field}`", gate_field(owner));
    let other = ALTERNATIVES.iter().find(|(word, _)| *word == field);
    let other = other.map_or_else(|| format!("{field}_"), |(_, other)| (*other).to_owned());
    OF_RUST
        .at(format!("gate name `{}` is a Rust keyword", name.value), name.span, label)
        .suggest(format!("choose another name, for example `{other}`"), renames.edits(Noun::Gate, name, &other))
        .note(
            "checked against the keywords of editions 2015 to 2024 and the reserved ones (`gen`, `try`, `yield`, ...)",
        )
}

/// SCL0315.
pub(crate) const FOREIGN: Rule = Rule {
    code: "SCL0315",
    severity: Severity::Warning,
    title: "name is reserved in C++ or Python",
    explanation: "The name is a keyword of C++ or Python, or has two underscores in a row, which C++ reserves. Programs in \
                  these languages read the same file, and cannot use the name for a variable, a field or a module; \
                  code that `scl generate` writes for them appends an underscore. Choose a name that says more; if no \
                  such program will ever exist, allow the warning.",
    example: " components:
   - name: scheduler
     gates:
-      - delete: sub
+      - delete_job: sub
",
};

fn check_foreign<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    for (noun, name) in names(model).filter(|(noun, name)| noun.is_well_formed(&name.value)) {
        let field = gate_field(&name.value);
        let spellings = match noun {
            Noun::System => continue,
            // Rust keywords are reported by other rules.
            Noun::Gate | Noun::Parameter if is_keyword(&field) => continue,
            _ if is_unescapable(&field) => continue,
            Noun::Gate | Noun::Parameter => vec![field],
            Noun::Kind | Noun::Component => vec![field, component_type(&name.value)],
        };
        problems.extend(spellings.iter().find_map(|spelling| find_foreign(renames, noun, name, spelling)));
    }
}

/// `spelling` is the name in the case of a field, a module or a class.
fn find_foreign<'m>(
    renames: &Renames<'m>,
    noun: Noun,
    name: &'m Spanned<String>,
    spelling: &str,
) -> Option<Diagnostic> {
    let start = format!("{} name `{}`", noun.word(), name.value);
    let languages = [("C++", is_cpp(spelling)), ("Python", is_python(spelling))];
    let languages: Vec<&str> = languages.into_iter().filter(|(_, has_it)| *has_it).map(|(name, _)| name).collect();
    let headline = match languages.as_slice() {
        // Leading underscores are reported by another rule.
        [] if spelling.trim_start_matches('_').contains("__") => {
            format!("{start} has two underscores in a row, which C++ reserves")
        }
        [] => return None,
        [one] => format!("{start} is a keyword of {one}"),
        _ => format!("{start} is a keyword of {}", all_of(&languages).replace('`', "")),
    };
    let label = if spelling == name.value { String::new() } else { format!("becomes `{spelling}`") };
    let another = match languages.as_slice() {
        [] => spelling.replace("__", "_"),
        _ => format!("{}_{}", spelling.to_ascii_lowercase(), noun.word()),
    };
    let found = FOREIGN
        .at(headline, name.span, label)
        .suggest(format!("choose another name, for example `{another}`"), renames.edits(noun, name, &another));
    Some(found.note("programs in C++ and Python read the same file"))
}

#[cfg(test)]
mod tests {
    use super::{FOREIGN, OF_RUST, UNUSABLE};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn gate_name_is_a_rust_keyword() {
        rule_example(
            &OF_RUST,
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
            &UNUSABLE,
            expect![[r#"
                error: [SCL0307] `crate` is a Rust keyword that cannot be used as a name, not even as `r#crate`
                 --> topology.yaml:2:11
                  |
                2 |   - name: crate
                  |           ^^^^^
                  |
                  = help: the name is any other word of letters, digits, `_` and `-`
                  = note: not usable either: `self`, `Self`, `super`, `_`
            "#]],
        );
    }

    #[test]
    fn name_is_reserved_in_cpp_or_python() {
        rule_example(
            &FOREIGN,
            expect![[r#"
            warning: [SCL0315] gate name `delete` is a keyword of C++
             --> topology.yaml:4:9
              |
            4 |       - delete: sub
              |         ^^^^^^
              |
              = help: choose another name, for example `delete_gate`
              = note: programs in C++ and Python read the same file
        "#]],
        );
    }
}
