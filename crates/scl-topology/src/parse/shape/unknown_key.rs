//! Unknown keys. SCL0202: at the top level. SCL0207: in a component. SCL0212: in a gate.

use super::habit::{converted, could_have, split, with_habit, with_lifted, with_spelling};
use super::option_value::filled;
use super::own_key;
use super::ports::with_gates;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity, removal};
use crate::grammar::{self, OPTIONS, is_whole_number, option};
use crate::habits::{self, Habit};
use crate::parse::entry::Entry;
use crate::parse::field::{Field, Fields};
use crate::parse::scalar;
use crate::parse::words::{COMPONENT_KEYS, SECTIONS};
use crate::source::{SourceFile, Span, Spanned};
use crate::suggest::similar;
use crate::topology::GateKind;
use crate::yaml::{Node, NodeKind};
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

pub(in crate::parse) fn section(field: Field<'_>, source: &SourceFile) -> Diagnostic {
    let message = format!("unknown section `{}`", field.key);
    let problem = SECTION.at(message, field.key_span, "not a section of a topology");
    if is_include(field) {
        let edit = Edit::new(field.key_span, grammar::INCLUDE);
        return problem.propose("other files of the system are named by `include`", [edit]);
    }
    let is_section = |key: &str| SECTIONS.contains(&key);
    let problem = with_lifted(problem, field, &habits::SECTIONS, is_section, source);
    let (problem, is_spelling) = with_spelling(problem, field, SECTIONS);
    match habits::SECTIONS.find(field.key) {
        _ if is_spelling => problem,
        Some(habit) => with_habit(problem, habit, field, |_| true),
        None => problem.did_you_mean(field.key, &similar(field.key, SECTIONS)),
    }
    .note(format!("sections: {}", quoted_list(SECTIONS)))
    .note("keys that start with `x-` are ignored, for your own use")
}

/// `imports: sprayer.yaml`: other files whose components are meant to belong to this one.
pub(in crate::parse) fn is_include(field: Field<'_>) -> bool {
    let is_file = |node: &Node| node.text().is_some_and(|text| text.ends_with(".yaml") || text.ends_with(".yml"));
    match &field.value.kind {
        NodeKind::Sequence { items } => !items.is_empty() && items.iter().all(is_file),
        _ => is_file(field.value),
    }
}

/// SCL0207.
pub(crate) const OF_COMPONENT: Rule = Rule {
    code: "SCL0207",
    severity: Severity::Error,
    title: "unknown key in a component",
    explanation: "A component has the keys `name`, `gates`, `doc`, `optional` and `kind`, and a kind has all of \
                  them but the last. This key is probably misspelt; ignoring it would hide the mistake. Correct or \
                  remove it.",
    example: " components:
   - name: sensor
-    gate:
+    gates:
       - measurements: pub
",
};

/// An unknown key in a component or a kind; `last` is the last connection of the file.
pub(in crate::parse) fn of_component(
    field: Field<'_>,
    name: &str,
    entry: Entry,
    last: Option<Span>,
    source: &SourceFile,
) -> Diagnostic {
    let word = entry.word();
    let message = format!("unknown key `{}` in {word} `{name}`", field.key);
    let problem = OF_COMPONENT.at(message, field.key_span, format!("not a key of a {word}"));
    let problem = own_key(problem, field.key);
    if field.key == grammar::KIND {
        return problem.help("kinds are not nested: a kind has `gates` of its own").note(keys_of(entry));
    }
    let (problem, is_spelling) = with_spelling(problem, field, entry.keys().iter().copied());
    let owner = match entry {
        Entry::Component => name.to_owned(),
        Entry::Kind => format!("each {name}"),
    };
    match habits::COMPONENT.find(field.key) {
        _ if is_spelling => problem,
        Some(habit) => match with_gates(problem, habit, field, &owner, last, source) {
            problem if problem.proposals().next().is_some() => problem.otherwise(habit.text),
            problem => with_habit(problem, habit, field, |_| true),
        },
        None => problem.did_you_mean(field.key, &similar(field.key, entry.keys().iter().copied())),
    }
    .note(keys_of(entry))
}

fn keys_of(entry: Entry) -> String {
    format!("keys of a {}: {}", entry.word(), quoted_list(entry.keys()))
}

/// Whether a key was probably meant to be `name`.
pub(in crate::parse) fn is_misnamed(key: &str) -> bool {
    let is_near = !COMPONENT_KEYS.contains(&key) && similar(key, COMPONENT_KEYS).first() == Some(&"name");
    is_near || is_called_name(key)
}

/// Whether other tools use the word for a name.
fn is_called_name(key: &str) -> bool {
    habits::COMPONENT.find(key).is_some_and(|habit| habit.ways == ["name"])
}

/// The key that was probably meant to be `name`.
pub(in crate::parse) fn misnamed<'n>(fields: &Fields<'n>) -> Option<Field<'n>> {
    fields.list.iter().copied().find(|field| is_misnamed(field.key) && scalar(field.value).is_some())
}

/// A key in the place of `name`.
pub(in crate::parse) fn instead_of_name(field: Field<'_>, entry: Entry) -> Diagnostic {
    let message = format!("unknown key `{}` in a {}", field.key, entry.word());
    let problem = OF_COMPONENT.at(message, field.key_span, "expected `name`");
    let text = match is_called_name(field.key) {
        true => "it is called `name` here",
        false => "a key with a similar name exists: `name`",
    };
    problem.propose(text, [Edit::new(field.key_span, "name")]).note(keys_of(entry))
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
pub(in crate::parse) fn of_gate(field: Field<'_>, kind: Field<'_>, path: &str, source: &SourceFile) -> Diagnostic {
    let message = format!("unknown key `{}` in gate `{path}`", field.key);
    let problem = own_key(OF_GATE.at(message, field.key_span, ""), field.key);
    let problem = with_lifted(problem, field, &habits::GATE, |key| option(key).is_some(), source);
    let problem = with_type(problem, field, kind, source);
    let kind = kind.key;
    let fits = |key: &&str| only_of(key, kind).is_empty();
    let (problem, is_spelling) = with_spelling(problem, field, OPTIONS.iter().map(|option| option.key).filter(fits));
    let problem = match habits::GATE.find(field.key) {
        _ if is_spelling && field.value.text().is_none_or(|text| !is_whole_number(text)) => problem,
        Some(habit) => with_habit(problem, habit, field, |key| only_of(key, kind).is_empty()),
        None => match habits::of_part(field.key) {
            Some(habit) => with_part(problem, habit, field, kind),
            None => with_similar(problem, field, kind),
        },
    };
    let keys = OPTIONS.iter().filter(|option| option.kinds.iter().any(|of| of.word() == kind)).map(|option| option.key);
    match GateKind::of(kind).is_some() {
        true => problem.note(format!("keys of a `{kind}` gate: {}", quoted_list(std::iter::once(kind).chain(keys)))),
        false => problem.note(format!("keys of a gate: {}", quoted_list(OPTIONS.iter().map(|option| option.key)))),
    }
}

/// A misspelt key of a gate in `everyone`.
pub(in crate::parse) fn of_shared_gate(key: &Spanned<String>, meant: &str, gate: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in gate `{}.{gate}`", key.value, grammar::EVERYONE);
    OF_GATE.at(message, key.span, "").did_you_mean(&key.value, &[meant])
}

/// `{pub: , type: Fix}`: the type belongs after the kind.
fn with_type(problem: Diagnostic, field: Field<'_>, kind: Field<'_>, source: &SourceFile) -> Diagnostic {
    let is_type = habits::GATE.find(field.key).is_some_and(|habit| habit.is_type());
    let entry = field.key_span.to(field.value.span);
    match (scalar(field.value), removal(source, entry)) {
        (Some(name), Some(removed)) if is_type && kind.value.is_null() => problem
            .propose(format!("write `{}: {}`", kind.key, name.value), [filled(kind, &name.value, source), removed]),
        _ => problem,
    }
}

/// The option that another tool calls by the name of this key, with its value if that is another one, if only other
/// kinds of gates have it.
pub(in crate::parse) fn misplaced(field: Field<'_>, kind: GateKind) -> Option<(String, Option<String>)> {
    let ways = habits::GATE.find(field.key)?.ways.iter().map(|way| split(way));
    let fits = |key: &str| option(key).is_none_or(|option| option.fits(kind));
    let (key, value) = ways.clone().next().filter(|_| !ways.clone().any(|(key, _)| fits(key)))?;
    Some((key.to_owned(), value.map(str::to_owned).or_else(|| converted(key, field))))
}

/// An option that a part of a longer key stands for, if the option could have the value.
fn with_part(problem: Diagnostic, habit: &'static Habit, field: Field<'_>, kind: &str) -> Diagnostic {
    let takes = |key: &str| only_of(key, kind).is_empty() && could_have(key, field);
    match habit.ways.iter().any(|key| takes(key)) {
        true => {
            let mut problem = with_habit(problem, habit, field, takes);
            problem.doubt();
            problem
        }
        false => with_similar(problem, field, kind),
    }
}

/// Options whose names are similar to an unknown key.
fn with_similar(mut problem: Diagnostic, field: Field<'_>, kind: &str) -> Diagnostic {
    for name in similar(field.key, OPTIONS.iter().map(|option| option.key)) {
        // An option that this kind does not have would be the next mistake.
        problem = match only_of(name, kind) {
            kinds if kinds.is_empty() => problem.choose_word(SIMILAR_KEY, field.key, &[name]),
            kinds => problem.help(format!("{}`{name}`{kinds}", SIMILAR_KEY.0)),
        };
    }
    problem
}

/// `{pub: Fix, doc: One, two}`: `two` is a key, because the text has no quotes. `text` is all of it.
pub(in crate::parse) fn comma_in_doc(key: Span, text: Span, source: &SourceFile, path: &str) -> Diagnostic {
    let message = format!("the text of `doc` in gate `{path}` ends at its comma");
    let problem = OF_GATE.at(message, key, "read as a key of the gate");
    let words = source.snippet(text);
    // These characters would need escaping in double quotes.
    if words.contains(['"', '\\']) {
        let quoted = format!("'{}'", words.replace('\'', "''"));
        return problem.propose(format!("put it in quotes: `doc: {quoted}`"), [Edit::new(text, quoted)]);
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
                  = note: sections: `components`, `connections`, `kinds`, `everyone`, `include`, `exports`, `system`, `schemas`, `schema_roots`, `codec`, `scl`
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
                  = note: keys of a component: `name`, `gates`, `doc`, `optional`, `memory`, `parameters`, `kind`"#]],
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
              = help: put it in quotes: `doc: 'It says "one", two.'`

            error: [SCL0212] unknown key `que` in gate `sensor.measurements`
             --> topology.yaml:4:52
              |
            4 |       - measurements: {pub: Measurement, doc: One, que: 4}
              |                                                    ^^^
              |
              = help: a key with a similar name exists: `queue`, for `sub` and `pull` gates
              = note: keys of a `pub` gate: `pub`, `doc`, `codec`, `backpressure`, `latched`, `rate`, `period`, `unconnected`
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
                  = note: keys of a `pub` gate: `pub`, `doc`, `codec`, `backpressure`, `latched`, `rate`, `period`, `unconnected`"#]],
        );
    }
}
