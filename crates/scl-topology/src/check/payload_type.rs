//! SCL0403: a text that is no type name. SCL0404: one type where two are needed, or two where one is. Sets the payload
//! of every other gate.

use super::draft::{Draft, DraftGate};
use super::payload_fault::{self, Fault};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::{Span, Spanned};
use crate::topology::{GateKind, Payload, TypeName};
use scl_text::list::listed;
use std::collections::HashMap;

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
        let types = written.value.split("->");
        gate.is_misfit =
            gate.kind.is_some() && read.is_none() && types.clone().all(|part| payload_fault::of(part.trim()).is_none());
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
        match payload_fault::of(part) {
            None => types.push(TypeName { dotted: (*part).to_owned(), span, in_schemas: false }),
            Some(fault) => {
                let whole = Some(written.span).filter(|_| !parts.iter().any(|part| payload_fault::of(part).is_none()));
                problems.push(no_type(draft, part, span, whole, fault));
            }
        }
    }
    if types.len() != parts.len() {
        return None;
    }
    fit(gate.kind?, types)
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

/// Reports types that are too few or too many for the kind of their gate. Looks at the gates at the other ends of its
/// connections, so it runs once those are known.
pub(super) fn check_number(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let mut partners: HashMap<usize, usize> = HashMap::new();
    for link in &draft.links {
        if let [Some(one), Some(two)] = link.ends {
            partners.entry(one).or_insert(two);
            partners.entry(two).or_insert(one);
        }
    }
    let replies = replies(draft);
    for (at, gate) in draft.gates.iter().enumerate().filter(|(_, gate)| gate.is_misfit) {
        let (Some(written), Some(kind)) = (gate.model.payload.as_ref(), gate.kind) else { continue };
        let parts: Vec<&str> = written.value.split("->").map(str::trim).collect();
        let partner = partners.get(&at).map(|partner| &draft.gates[*partner]);
        problems.push(misfit(draft, gate, kind, written, &parts, (partner, &replies)));
    }
}

/// Maximum number of replies that are offered.
const MOST_REPLIES: usize = 3;

/// The replies of the file, in its order, as far as they are offered for a gate that has none.
fn replies<'d>(draft: &'d Draft<'_>) -> Vec<&'d str> {
    let mut replies: Vec<&str> = Vec::new();
    for gate in &draft.gates {
        if let Some(Payload::Exchange { reply, .. }) = &gate.payload
            && replies.len() < MOST_REPLIES
            && !replies.contains(&reply.dotted())
        {
            replies.push(reply.dotted());
        }
    }
    replies
}

fn misfit(
    draft: &Draft<'_>,
    gate: &DraftGate<'_>,
    kind: GateKind,
    written: &Spanned<String>,
    parts: &[&str],
    (partner, replies): (Option<&DraftGate<'_>>, &[&str]),
) -> Diagnostic {
    let word = kind.word();
    let given = format!("{} types are given", parts.len());
    let types = |types: &str| Edit::new(written.span, draft.sources.quoted_as(written.span, types));
    let kind_edit = |kind: GateKind| Edit::new(gate.model.kind.span, kind.word());
    match (kind, parts) {
        (GateKind::Req | GateKind::Rep, [only]) => {
            let takes = match kind {
                GateKind::Req => "what it asks and what it gets back",
                _ => "what it is asked and what it answers",
            };
            let headline = format!("a `{word}` gate needs two types, {takes}");
            let found = WRONG_NUMBER_OF_TYPES.at(headline, written.span, "only one type is given");
            let found = match partner.and_then(|partner| partner.payload.as_ref()) {
                Some(both @ Payload::Exchange { .. }) => {
                    let both = both.to_string();
                    found.propose(format!("write `{both}`, as at the other end"), [types(&both)])
                }
                _ => {
                    let ways: Vec<String> = replies.iter().map(|reply| format!("{only} -> {reply}")).collect();
                    let ways = ways.iter().map(|way| (way.as_str(), types(way)));
                    let mut found = found.choose(("write ", ", if that is the reply"), ways);
                    found.doubt();
                    found
                }
            };
            let both = format!(
                "request and reply are joined by `->`: `{only} -> ` and the type of the reply, perhaps an empty message"
            );
            let one_way = |found: Diagnostic, other: GateKind| {
                let does = if other.is_source() { "sends" } else { "receives" };
                let help = format!("write `{}` if it only {does} `{only}`", other.word());
                found.suggest(help, [kind_edit(other)])
            };
            match partner.and_then(|partner| partner.kind) {
                Some(GateKind::Req | GateKind::Rep) => found.otherwise(both),
                Some(other) => one_way(found, other.opposite()).help(both),
                None if kind == GateKind::Req => one_way(one_way(found.help(both), GateKind::Sub), GateKind::Pub),
                None => one_way(one_way(found.help(both), GateKind::Pub), GateKind::Sub),
            }
        }
        (GateKind::Req | GateKind::Rep, _) => {
            let headline = format!("a `{word}` gate has two types, a request and its reply");
            let found = WRONG_NUMBER_OF_TYPES.at(headline, written.span, given);
            let (between, last) = (&parts[1..parts.len() - 1], parts[parts.len() - 1]);
            let way = format!("{} -> {last}", parts[0]);
            let needs =
                if between.len() == 1 { "needs a `pub` gate of its own" } else { "need `pub` gates of their own" };
            found.suggest(format!("write `{way}`; {} {needs}", listed(between)), [types(&way)])
        }
        _ => {
            let (does, meant) = match kind {
                GateKind::Pub | GateKind::Push => ("sends one type and gets no answer", GateKind::Req),
                _ => ("receives one type and gives no answer", GateKind::Rep),
            };
            let headline = format!("a `{word}` gate {does}");
            let found = WRONG_NUMBER_OF_TYPES.at(headline, written.span, given);
            let at_partner = match partner.and_then(|partner| partner.payload.as_ref()) {
                Some(Payload::Message(message)) => parts.iter().find(|part| **part == message.dotted()),
                _ => None,
            };
            let found = match at_partner {
                Some(only) => found.suggest(format!("write `{only}` alone, as at the other end"), [types(only)]),
                None => found.suggest(format!("write `{}` alone, if there is no answer", parts[0]), [types(parts[0])]),
            };
            match parts.len() {
                2 => found.suggest(format!("write `{}`, if there is one", meant.word()), [kind_edit(meant)]),
                _ => found,
            }
        }
    }
}

/// The problem of a text at `span`. `whole` is the place of all types, if nothing is lost without them.
fn no_type(draft: &Draft<'_>, text: &str, span: Span, whole: Option<Span>, fault: Fault) -> Diagnostic {
    let headline = match text {
        "" => "a message type is missing".to_owned(),
        _ => format!("`{text}` cannot be a message type"),
    };
    let ways: Vec<(&str, Edit)> =
        fault.meant.iter().map(|name| (name.as_str(), Edit::new(span, draft.sources.quoted_as(span, name)))).collect();
    let mut found = NO_TYPE_NAME.at(headline, span, fault.label).about(text).choose(("write ", ""), ways);
    if !fault.is_certain {
        found.doubt();
    }
    match whole.filter(|_| fault.is_bytes) {
        Some(whole) => {
            found.propose(format!("write nothing after the colon: {}", fault.allowed), [Edit::new(whole, "")])
        }
        None if fault.is_bytes => found
            .help("request and reply are both messages; one without fields, `message Done {}`, says only that it came"),
        None => found.otherwise(fault.allowed),
    }
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
                  = help: write `String`
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
                  = help: request and reply are joined by `->`: `Command -> ` and the type of the reply, perhaps an empty message
                  = help: write `sub` if it only receives `Command`
                  = help: write `pub` if it only sends `Command`
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
            pub: 'Vec<u8>'   SCL0403 `Vec<u8>` cannot be a message type [write nothing after the colon: a gate without a type carries bytes]
            pub: '&mut T'    SCL0403 `&mut T` cannot be a message type [write `T`]
            pub: '(A, B)'    SCL0403 `(A, B)` cannot be a message type [several values are the fields of one message or struct]
            pub: 'dyn T'     SCL0403 `dyn T` cannot be a message type [a type is a struct or an enum]
            pub: a..b        SCL0403 `a..b` cannot be a message type [write `a.b`]
            pub: a.2         SCL0403 `a.2` cannot be a message type [a type is a dotted name; its parts are words of letters, digits and `_`]
            pub: _           SCL0403 `_` cannot be a message type [a type is a dotted name; its parts are words of letters, digits and `_`]
            pub: A -> B      SCL0404 a `pub` gate sends one type and gets no answer [write `A` alone, if there is no answer]
            sub: A -> B      SCL0404 a `sub` gate receives one type and gives no answer [write `A` alone, if there is no answer | write `rep`, if there is one]
            rep: A           SCL0404 a `rep` gate needs two types, what it is asked and what it answers [request and reply are joined by `->`: `A -> ` and the type of the reply, perhaps an empty message | write `pub` if it only sends `A` | write `sub` if it only receives `A`]
            req: A -> B -> C SCL0404 a `req` gate has two types, a request and its reply [write `A -> C`; `B` needs a `pub` gate of its own]
            req: 'A ->'      SCL0403 a message type is missing [a type is a dotted name; its parts are words of letters, digits and `_`]
        "#]].assert_eq(&told);
    }

    #[test]
    fn replies_of_other_gates_are_offered() {
        let gates = "    gates:\n      - x: {rep: A}\n      - y: {rep: B -> Done}\n      - z: {rep: C -> State}\n";
        let told = advice(&format!("components:\n  - name: a\n{gates}connections: []\n"));
        assert!(told.contains("[write `A -> Done` or `A -> State`, if that is the reply | "), "{told}");
    }
}
