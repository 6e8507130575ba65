//! SCL0403: a text that is no type name. SCL0404: one type where two are needed, or two where one is. Sets the payload
//! of every other gate.

use super::draft::{Draft, DraftGate};
use super::named;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::source::{Span, Spanned};
use crate::topology::{GateKind, Payload, TypeName};

/// SCL0403.
pub(crate) const NO_TYPE_NAME: Rule = Rule {
    code: "SCL0403",
    severity: Severity::Error,
    title: "not a type name",
    explanation: "A message type is a dotted name such as `uav.Measurement`. References, generics, paths with `::` and \
                  types without a name cannot be one, because the file is read by tools in several languages. Give the \
                  type a name.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: \"&str\"}
+      - measurements: {pub: Text}
",
};

/// SCL0404.
pub(crate) const WRONG_NUMBER_OF_TYPES: Rule = Rule {
    code: "SCL0404",
    severity: Severity::Error,
    title: "types do not fit the kind",
    explanation: "`req` and `rep` carry a question and its answer, `A -> B`; the other kinds carry one type. This gate \
                  has too many types or too few. Write the types as the message shows, or use another kind.",
    example: " components:
   - name: ui
     gates:
-      - commands: {req: Command}
+      - commands: {req: Command -> Status, unconnected: ok}
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    for at in 0..draft.gates.len() {
        let gate = &draft.gates[at];
        let Some(written) = gate.model.payload.as_ref() else {
            if gate.kind.is_none() {
                draft.gates[at].payload = None;
            }
            continue;
        };
        let read = read_payload(draft, gate, written, problems);
        let gate = &mut draft.gates[at];
        gate.payload = if gate.payload.is_some() { read } else { None };
    }
}

fn read_payload(
    draft: &Draft<'_>,
    gate: &DraftGate<'_>,
    written: &Spanned<String>,
    problems: &mut Diagnostics,
) -> Option<Payload> {
    let parts: Vec<&str> = written.value.split("->").map(str::trim).collect();
    let mut types = Vec::new();
    for (at, part) in parts.iter().enumerate() {
        let span = if parts.len() == 1 { written.span } else { draft.part(written.span, part, at > 0) };
        match fault(part) {
            None => types.push(TypeName { dotted: (*part).to_owned(), span, in_schemas: false }),
            Some(fault) => problems.push(no_type(part, span, fault)),
        }
    }
    if types.len() != parts.len() {
        return None;
    }
    let fitted = fit(gate.kind?, types);
    if fitted.is_none() {
        problems.push(misfit(gate, gate.kind?, written, &parts));
    }
    fitted
}

fn fit(kind: GateKind, types: Vec<TypeName>) -> Option<Payload> {
    let asks = matches!(kind, GateKind::Req | GateKind::Rep);
    let mut types = types.into_iter();
    match (asks, types.next(), types.next(), types.next()) {
        (false, Some(message), None, None) => Some(Payload::Message(message)),
        (true, Some(request), Some(reply), None) => Some(Payload::Exchange { request, reply }),
        _ => None,
    }
}

fn misfit(gate: &DraftGate<'_>, kind: GateKind, written: &Spanned<String>, parts: &[&str]) -> Diagnostic {
    let name = &gate.model.name.value;
    let word = kind.word();
    let given = format!("{} types are given", parts.len());
    match (kind, parts) {
        (GateKind::Req | GateKind::Rep, [only]) => {
            let takes = match kind {
                GateKind::Req => "what it asks and what it gets back",
                _ => "what it is asked and what it answers",
            };
            let headline = format!("a `{word}` gate needs two types, {takes}");
            WRONG_NUMBER_OF_TYPES
                .at(headline, written.span, "only one type is given")
                .help(format!("write `{name}: {{{word}: {only} -> Status}}`"))
        }
        (GateKind::Req | GateKind::Rep, _) => {
            let headline = format!("a `{word}` gate has two types, a request and its reply");
            let (first, last) = (parts[0], parts[parts.len() - 1]);
            WRONG_NUMBER_OF_TYPES
                .at(headline, written.span, given)
                .help(format!("write `{name}: {{{word}: {first} -> {last}}}`"))
        }
        _ => {
            let (does, meant) = match kind {
                GateKind::Pub | GateKind::Push => ("sends one type and gets no answer", "req"),
                _ => ("receives one type and gives no answer", "rep"),
            };
            let headline = format!("a `{word}` gate {does}; did you mean `{meant}`?");
            WRONG_NUMBER_OF_TYPES
                .at(headline, written.span, given)
                .help(format!("write `{name}: {{{word}: {}}}`", parts[0]))
                .help(format!("or `{name}: {{{meant}: {}}}`", written.value.trim()))
        }
    }
}

/// Why a text is no type name, and what to write instead.
fn fault(text: &str) -> Option<(&'static str, String)> {
    let is_word = |word: &str| word != "_" && named::is_word(word);
    if text.split('.').all(is_word) {
        return None;
    }
    let dotted = text.trim_start_matches("::").replace("::", ".");
    let owned = text.trim_start_matches('&').trim_start_matches("mut ").trim();
    let owned = if owned == "str" { "String" } else { owned };
    Some(match text {
        "" => ("nothing here", "write a type, for example `Status`".to_owned()),
        _ if text.starts_with('&') => ("a reference", format!("use an owned type: `{owned}`")),
        _ if dotted != text && dotted.split('.').all(is_word) => ("a Rust path", format!("write `{dotted}`")),
        _ if text.contains('<') => ("a type with parameters", "give it a name in Rust: `type Name = ...;`".to_owned()),
        _ if text.starts_with(['(', '[']) => ("a type without a name", "make a struct of it, and name it".to_owned()),
        _ if text.starts_with("dyn ") || text.starts_with("impl ") => {
            ("a trait", "use a type, such as a struct or an enum".to_owned())
        }
        _ if text.contains("..") || text.starts_with('.') || text.ends_with('.') => {
            ("a part between the dots is empty", "write each part of the name".to_owned())
        }
        _ => ("not a dotted name", "write a name such as `uav.Measurement`".to_owned()),
    })
}

fn no_type(text: &str, span: Span, (label, help): (&str, String)) -> Diagnostic {
    let headline = match text {
        "" => "a message type is missing".to_owned(),
        _ => format!("`{text}` cannot be a message type"),
    };
    NO_TYPE_NAME.at(headline, span, label).help(help).note(
        "a message type is a dotted name, such as `uav.Measurement`: words of letters, digits and `_`, joined by `.`",
    )
}

#[cfg(test)]
mod tests {
    use super::{NO_TYPE_NAME, WRONG_NUMBER_OF_TYPES};
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn not_a_type_name() {
        rule_example(
            &NO_TYPE_NAME,
            expect![[r#"
            error: [SCL0403] `&str` cannot be a message type
             --> topology.yaml:4:29
              |
            4 |       - measurements: {pub: "&str"}
              |                             ^^^^^^ a reference
              |
              = help: use an owned type: `String`
              = note: a message type is a dotted name, such as `uav.Measurement`: words of letters, digits and `_`, joined by `.`
        "#]],
        );
    }

    #[test]
    fn types_do_not_fit_the_kind() {
        rule_example(
            &WRONG_NUMBER_OF_TYPES,
            expect![[r#"
            error: [SCL0404] a `req` gate needs two types, what it asks and what it gets back
             --> topology.yaml:4:25
              |
            4 |       - commands: {req: Command}
              |                         ^^^^^^^ only one type is given
              |
              = help: write `commands: {req: Command -> Status}`
        "#]],
        );
    }

    #[test]
    fn other_texts_that_are_no_types() {
        let gates = [
            "pub: 'nav::Fix'",
            "pub: 'Vec<u8>'",
            "pub: '&mut T'",
            "pub: '(A, B)'",
            "pub: 'dyn T'",
            "pub: a..b",
            "pub: a.2",
            "pub: _",
            "pub: A -> B",
            "sub: A -> B",
            "rep: A",
            "req: A -> B -> C",
            "req: 'A ->'",
        ];
        let advice = |gate: &str| advice(&format!("components:\n  - name: a\n    gates:\n      - x: {{{gate}}}\n"));
        let told: String = gates.iter().map(|gate| format!("{gate:16} {}\n", advice(gate))).collect();
        expect![[r#"
            pub: 'nav::Fix'  SCL0403 `nav::Fix` cannot be a message type [write `nav.Fix`]
            pub: 'Vec<u8>'   SCL0403 `Vec<u8>` cannot be a message type [give it a name in Rust: `type Name = ...;`]
            pub: '&mut T'    SCL0403 `&mut T` cannot be a message type [use an owned type: `T`]
            pub: '(A, B)'    SCL0403 `(A, B)` cannot be a message type [make a struct of it, and name it]
            pub: 'dyn T'     SCL0403 `dyn T` cannot be a message type [use a type, such as a struct or an enum]
            pub: a..b        SCL0403 `a..b` cannot be a message type [write each part of the name]
            pub: a.2         SCL0403 `a.2` cannot be a message type [write a name such as `uav.Measurement`]
            pub: _           SCL0403 `_` cannot be a message type [write a name such as `uav.Measurement`]
            pub: A -> B      SCL0404 a `pub` gate sends one type and gets no answer; did you mean `req`? [write `x: {pub: A}` | or `x: {req: A -> B}`]
            sub: A -> B      SCL0404 a `sub` gate receives one type and gives no answer; did you mean `rep`? [write `x: {sub: A}` | or `x: {rep: A -> B}`]
            rep: A           SCL0404 a `rep` gate needs two types, what it is asked and what it answers [write `x: {rep: A -> Status}`]
            req: A -> B -> C SCL0404 a `req` gate has two types, a request and its reply [write `x: {req: A -> C}`]
            req: 'A ->'      SCL0403 a message type is missing [write a type, for example `Status`]
        "#]].assert_eq(&told);
    }
}
