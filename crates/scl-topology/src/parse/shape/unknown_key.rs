//! Unknown keys. SCL0202: at the top level. SCL0207: in a component. SCL0212: in a gate.

use super::own_key;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::grammar::{OPTIONS, option};
use crate::parse::field::{Field, Fields};
use crate::parse::scalar;
use crate::parse::words::{COMPONENT_KEYS, SECTIONS};
use crate::source::{SourceFile, Span};
use crate::suggest::similar;
use crate::topology::GateKind;
use scl_text::list::{all_of, quoted_list};

/// SCL0202.
pub(crate) const SECTION: Rule = Rule {
    code: "SCL0202",
    severity: Severity::Error,
    title: "unknown top-level key",
    explanation: "The key is not a section of a topology. It is probably misspelt; ignoring it would hide the mistake. \
                  Correct it; keys that start with `x-` are free for your own use.",
    example: " components: []
-conections: []
+connections: []
",
};

pub(in crate::parse) fn section(field: Field<'_>) -> Diagnostic {
    let message = format!("unknown section `{}`", field.key);
    let problem = SECTION.at(message, field.key_span, "not a section of a topology");
    let meant = similar(field.key, SECTIONS);
    problem
        .did_you_mean(field.key, &meant)
        .note(format!("sections: {}", quoted_list(SECTIONS)))
        .note("keys that start with `x-` are ignored, for your own use")
}

/// SCL0207.
pub(crate) const OF_COMPONENT: Rule = Rule {
    code: "SCL0207",
    severity: Severity::Error,
    title: "unknown key in a component",
    explanation: "A component has the keys `name`, `gates`, `doc` and `optional`. This key is probably misspelt; \
                  ignoring it would hide the mistake. Correct or remove it.",
    example: " components:
   - name: sensor
-    gate:
+    gates:
       - measurements: pub
",
};

pub(in crate::parse) fn of_component(field: Field<'_>, component: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in component `{component}`", field.key);
    let problem = OF_COMPONENT.at(message, field.key_span, "not a key of a component");
    own_key(problem, field.key)
        .did_you_mean(field.key, &similar(field.key, COMPONENT_KEYS))
        .note(format!("keys of a component: {}", quoted_list(COMPONENT_KEYS)))
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
    let problem =
        OF_COMPONENT.at(format!("unknown key `{}` in a component", field.key), field.key_span, "expected `name`");
    match OTHER_WORDS.contains(&field.key) {
        true => problem.help(format!("write `name: {name}`")),
        false => problem.propose("a key with a similar name exists: `name`", [Edit::new(field.key_span, "name")]),
    }
    .note(format!("keys of a component: {}", quoted_list(COMPONENT_KEYS)))
}

/// SCL0212.
pub(crate) const OF_GATE: Rule = Rule {
    code: "SCL0212",
    severity: Severity::Error,
    title: "unknown key in a gate",
    explanation: "The keys of a gate are its kind and its options. This key is neither; it is probably misspelt. The \
                  message lists the options of this kind of gate.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: Measurement, que: 4}
+      - measurements: {sub: Measurement, queue: 4}
",
};

/// The text around a similar key.
const SIMILAR_KEY: (&str, &str) = ("a key with a similar name exists: ", "");

/// An unknown key in a gate. `kind` is the kind as written, `path` the gate with its component.
pub(in crate::parse) fn of_gate(field: Field<'_>, kind: &str, path: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in gate `{path}`", field.key);
    let mut problem = own_key(OF_GATE.at(message, field.key_span, ""), field.key);
    let similar = similar(field.key, OPTIONS.iter().map(|option| option.key));
    for name in similar {
        // An option that this kind does not have would be the next mistake.
        problem = match only_of(name, kind) {
            kinds if kinds.is_empty() => problem.choose_word(SIMILAR_KEY, field.key, &[name]),
            kinds => problem.help(format!("{}`{name}`{kinds}", SIMILAR_KEY.0)),
        };
    }
    let keys = OPTIONS.iter().filter(|option| option.kinds.iter().any(|of| of.word() == kind)).map(|option| option.key);
    match GateKind::of(kind).is_some() {
        true => problem.note(format!("keys of a `{kind}` gate: {}", quoted_list(std::iter::once(kind).chain(keys)))),
        false => problem.note(format!("keys of a gate: {}", quoted_list(OPTIONS.iter().map(|option| option.key)))),
    }
}

/// `{pub: Fix, doc: One, two}`: `two` is a key, because the text has no quotes. `text` is all of it.
pub(in crate::parse) fn comma_in_doc(key: Span, text: Span, source: &SourceFile, path: &str) -> Diagnostic {
    let message = format!("the text of `doc` in gate `{path}` ends at its comma");
    let problem = OF_GATE.at(message, key, "read as a key of the gate");
    let words = source.snippet(text);
    // These characters would need escaping in double quotes.
    if words.contains(['"', '\\', '\n']) {
        return problem.help("put the text in single quotes");
    }
    problem.propose(format!("put it in quotes: `doc: \"{words}\"`"), [Edit::new(text, format!("\"{words}\""))])
}

/// Names the kinds that have an option; empty if this kind is one of them.
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
    use super::{OF_COMPONENT, OF_GATE, SECTION};
    use crate::diagnostic::render;
    use crate::parse::testing::{check, parse_text};
    use expect_test::expect;

    #[test]
    fn unknown_section() {
        check(
            &SECTION,
            expect![[r#"
                error: [SCL0202] unknown section `conections`
                 --> topology.yaml:2:1
                  |
                2 | conections: []
                  | ^^^^^^^^^^ not a section of a topology
                  |
                  = help: did you mean `connections`?
                  = note: sections: `components`, `connections`, `system`, `schemas`, `schema_roots`, `codec`, `scl`
                  = note: keys that start with `x-` are ignored, for your own use"#]],
        );
    }

    #[test]
    fn key_of_a_component() {
        check(
            &OF_COMPONENT,
            expect![[r#"
                error: [SCL0207] unknown key `gate` in component `sensor`
                 --> topology.yaml:3:5
                  |
                3 |     gate:
                  |     ^^^^ not a key of a component
                  |
                  = help: did you mean `gates`?
                  = note: keys of a component: `name`, `gates`, `doc`, `optional`"#]],
        );
    }

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
    fn key_of_a_gate() {
        check(
            &OF_GATE,
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
