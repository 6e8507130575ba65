//! SCL0315: a name that C++ or Python reserves. The same file is read by programs in these languages.

use super::named::{Noun, is_well_formed, names};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::keywords::{CPP, PYTHON};
use crate::model::Model;
use crate::rust_name::{component_type, gate_field, is_keyword, is_unescapable};
use crate::source::Spanned;
use crate::wording::all_of;

/// SCL0315.
pub(crate) const RULE: Rule = Rule {
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

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model).filter(|(_, name)| is_well_formed(&name.value)) {
        let field = gate_field(&name.value);
        let spellings = match noun {
            Noun::System => continue,
            // Another rule tells what Rust reserves.
            Noun::Gate if is_keyword(&field) => continue,
            _ if is_unescapable(&field) => continue,
            Noun::Gate => vec![field],
            Noun::Component => vec![field, component_type(&name.value)],
        };
        problems.extend(spellings.iter().find_map(|spelling| find(noun, name, spelling)));
    }
}

/// `spelling` is the name in the case of a field, a module or a class.
fn find(noun: Noun, name: &Spanned<String>, spelling: &str) -> Option<Diagnostic> {
    let start = format!("{} name `{}`", noun.word(), name.value);
    let languages: Vec<&str> = [("C++", &CPP[..]), ("Python", &PYTHON)]
        .iter()
        .filter(|(_, words)| words.contains(&spelling))
        .map(|it| it.0)
        .collect();
    let headline = match languages.as_slice() {
        // Those at the start are an error of their own.
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
    Some(
        RULE.at(headline, name.span, label)
            .help(format!("choose another name, for example `{another}`"))
            .note("programs in C++ and Python read the same file"),
    )
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn name_is_reserved_in_cpp_or_python() {
        rule_example(
            &RULE,
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
