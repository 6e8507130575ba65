//! SCL0212: an unknown key in a gate.

use super::{own_key, ticked};
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::grammar::{OPTIONS, option};
use crate::parse::field::Field;
use crate::source::{SourceFile, Span};
use crate::suggest::similar;
use crate::topology::GateKind;
use crate::wording::all_of;

/// SCL0212.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0212",
    severity: Severity::Error,
    title: "unknown key in a gate",
    explanation: "A gate has its kind and options as keys. This key is neither, mostly because it is misspelt. The \
                  message lists the options that this kind of gate has.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: Measurement, que: 4}
+      - measurements: {sub: Measurement, queue: 4}
",
};

/// `kind` is the kind as written, `path` the gate with its component.
pub(in crate::parse) fn diagnose(field: Field<'_>, kind: &str, path: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in gate `{path}`", field.key);
    let mut problem = own_key(RULE.at(message, field.key_span, ""), field.key);
    let similar = similar(field.key, OPTIONS.iter().map(|option| option.key));
    // An option of other kinds would be the next mistake.
    if similar.iter().all(|name| only_of(name, kind).is_empty()) {
        problem = problem.fix_word(field.key, &similar);
    }
    for name in similar {
        problem = problem.help(format!("a key with a similar name exists: `{name}`{}", only_of(name, kind)));
    }
    let keys = OPTIONS.iter().filter(|option| option.kinds.iter().any(|of| of.word() == kind)).map(|option| option.key);
    match GateKind::of(kind).is_some() {
        true => problem.note(format!("keys of a `{kind}` gate: {}", ticked(std::iter::once(kind).chain(keys)))),
        false => problem.note(format!("keys of a gate: {}", ticked(OPTIONS.iter().map(|option| option.key)))),
    }
}

/// `{pub: Fix, doc: One, two}`: `two` is a key, because the text has no quotes. `text` is all of it.
pub(in crate::parse) fn comma_in_doc(key: Span, text: Span, source: &SourceFile, path: &str) -> Diagnostic {
    let message = format!("the text of `doc` in gate `{path}` ends at its comma");
    let problem = RULE.at(message, key, "read as a key of the gate");
    let words = source.snippet(text);
    // In double quotes, these would have to be written otherwise.
    if words.contains(['"', '\\', '\n']) {
        return problem.help("put the text in single quotes");
    }
    problem.help(format!("put it in quotes: `doc: \"{words}\"`")).fix(text, format!("\"{words}\""))
}

/// A word on the kinds that have an option, where this kind has not.
fn only_of(key: &str, kind: &str) -> String {
    let kinds = option(key).map_or(&[][..], |option| option.kinds);
    if kinds.iter().any(|of| of.word() == kind) {
        return String::new();
    }
    let words: Vec<&str> = kinds.iter().map(|of| of.word()).collect();
    format!(", for {} gates", all_of(&words))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::diagnostic::render;
    use crate::parse::testing::{check, parse_text};
    use expect_test::expect;

    #[test]
    fn a_comma_in_a_text_without_quotes() {
        let texts = ["doc: One, two, and three.", "doc: It says \"one\", two.", "doc: One, que: 4"];
        let problems = texts.map(|text| {
            let gate = format!("      - measurements: {{pub: Measurement, {text}}}");
            let (_, problems, sources) =
                parse_text(&format!("components:\n  - name: sensor\n    gates:\n{gate}\nconnections: []\n"));
            problems.iter().map(|problem| render(problem, &sources) + "\n").collect::<String>()
        });
        expect![[r#"
            error: [SCL0212] the text of `doc` in gate `sensor.measurements` ends at its comma
             --> topology.yaml:4:52
              |
            4 |       - measurements: {pub: Measurement, doc: One, two, and three.}
              |                                                    ^^^ read as a key of the gate
              |
              = help: put it in quotes: `doc: "One, two, and three."`

            error: [SCL0212] the text of `doc` in gate `sensor.measurements` ends at its comma
             --> topology.yaml:4:62
              |
            4 |       - measurements: {pub: Measurement, doc: It says "one", two.}
              |                                                              ^^^^ read as a key of the gate
              |
              = help: put the text in single quotes

            error: [SCL0212] unknown key `que` in gate `sensor.measurements`
             --> topology.yaml:4:52
              |
            4 |       - measurements: {pub: Measurement, doc: One, que: 4}
              |                                                    ^^^
              |
              = help: a key with a similar name exists: `queue`, for `sub` and `pull` gates
              = note: keys of a `pub` gate: `pub`, `doc`, `codec`, `backpressure`, `latched`, `unconnected`
        "#]]
        .assert_eq(&problems.join("\n"));
    }

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0212] unknown key `que` in gate `sensor.measurements`
             --> topology.yaml:4:42
              |
            4 |       - measurements: {pub: Measurement, que: 4}
              |                                          ^^^
              |
              = help: a key with a similar name exists: `queue`, for `sub` and `pull` gates
              = note: keys of a `pub` gate: `pub`, `doc`, `codec`, `backpressure`, `latched`, `unconnected`"#]],
        );
    }
}
