//! A requester and a replier of different types. SCL0602: the requests differ. SCL0603: the replies differ. SCL0604:
//! one end has request and reply swapped.

use super::draft::Draft;
use super::draft::differ;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::Span;
use crate::topology::{Payload, TypeName};

/// SCL0602.
pub(crate) const REQUESTS_DIFFER: Rule = Rule {
    code: "SCL0602",
    severity: Severity::Error,
    title: "request types differ",
    explanation: "The requester sends a different type than the replier expects. Use one request type at both ends; \
                  the message says whether the reply types agree.",
    example: " components:
   - name: controller
     gates:
       - commands: {rep: Command -> Status}
   - name: ui
     gates:
-      - commands: {req: Cmd -> Status}
+      - commands: {req: Command -> Status}
 connections:
   - [controller.commands, ui.commands]
",
};

/// SCL0603.
pub(crate) const REPLIES_DIFFER: Rule = Rule {
    code: "SCL0603",
    severity: Severity::Error,
    title: "reply types differ",
    explanation: "The replier answers with a different type than the requester expects. Use one reply type at both \
                  ends.",
    example: " components:
   - name: controller
     gates:
       - commands: {rep: Command -> Status}
   - name: ui
     gates:
-      - commands: {req: Command -> Ack}
+      - commands: {req: Command -> Status}
 connections:
   - [controller.commands, ui.commands]
",
};

/// SCL0604.
pub(crate) const SWAPPED_TYPES: Rule = Rule {
    code: "SCL0604",
    severity: Severity::Error,
    title: "request and reply swapped",
    explanation: "Both ends name the same two types in opposite order. On both ends, the left type is the request that \
                  the `req` gate sends, and the right type is the reply. Swap them on one end.",
    example: " components:
   - name: controller
     gates:
       - commands: {rep: Command -> Status}
   - name: ui
     gates:
-      - commands: {req: Status -> Command}
+      - commands: {req: Command -> Status}
 connections:
   - [controller.commands, ui.commands]
",
};

type Exchange<'a> = (&'a TypeName, &'a TypeName);

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    for (link, asker, answerer) in draft.flows() {
        let (Some(asked), Some(answered)) = (exchange(draft, asker), exchange(draft, answerer)) else { continue };
        let span = draft.links[link].model.span;
        let requests = differ(asked.0, answered.0);
        let replies = differ(asked.1, answered.1);
        let swapped = asked.0.dotted() == answered.1.dotted() && asked.1.dotted() == answered.0.dotted();
        match (requests, replies) {
            (false, false) => {}
            _ if swapped => problems.push(with_ways(draft, swap(span, asked, answered), [asker, answerer])),
            (false, true) => problems.push(with_ways(draft, reply(span, asked, answered), [asker, answerer])),
            (true, same) => {
                problems.push(with_ways(draft, request(span, asked, answered, !same), [asker, answerer]));
            }
        }
    }
}

fn exchange<'a>(draft: &'a Draft<'_>, gate: usize) -> Option<Exchange<'a>> {
    match &draft.gates[gate].payload {
        Some(Payload::Exchange { request, reply }) => Some((request, reply)),
        _ => None,
    }
}

/// Suggests the types of one end at the other.
fn with_ways(draft: &Draft<'_>, found: Diagnostic, [asker, answerer]: [usize; 2]) -> Diagnostic {
    let ways = [[asker, answerer], [answerer, asker]];
    ways.into_iter().fold(found, |found, [gate, other]| {
        let types = draft.gates[other].payload.as_ref().map(ToString::to_string);
        match (&draft.gates[gate].model.payload, types) {
            (Some(own), Some(types)) => {
                let edit = Edit::new(own.span, draft.sources.quoted_as(own.span, &types));
                found.suggest(format!("write `{types}` at `{}`", draft.path(gate)), [edit])
            }
            _ => found,
        }
    })
}

fn request(span: Span, asked: Exchange<'_>, answered: Exchange<'_>, replies_agree: bool) -> Diagnostic {
    let label = format!("`{}` is asked, `{}` is understood", asked.0.dotted(), answered.0.dotted());
    let found = REQUESTS_DIFFER
        .at("the request types of this connection differ", span, label)
        .label(answered.0.span(), "the replier understands this")
        .label(asked.0.span(), "the requester sends this");
    match replies_agree {
        true => found.note(format!("the reply types agree (`{}`)", asked.1.dotted())),
        false => found.note(format!("the reply types differ too: {}", replies(asked, answered))),
    }
}

fn reply(span: Span, asked: Exchange<'_>, answered: Exchange<'_>) -> Diagnostic {
    REPLIES_DIFFER
        .at("the reply types of this connection differ", span, replies(asked, answered))
        .label(answered.1.span(), "the replier answers this")
        .label(asked.1.span(), "the requester expects this")
        .note(format!("the request types agree (`{}`)", asked.0.dotted()))
}

/// Says how the replies differ, both for their own report and for the report about the requests.
fn replies(asked: Exchange<'_>, answered: Exchange<'_>) -> String {
    format!("`{}` is answered, `{}` is expected", answered.1.dotted(), asked.1.dotted())
}

fn swap(span: Span, asked: Exchange<'_>, answered: Exchange<'_>) -> Diagnostic {
    let (request, reply) = (answered.0.dotted(), answered.1.dotted());
    SWAPPED_TYPES
        .at("request and reply types are swapped on one end", span, "")
        .label(answered.0.span().to(answered.1.span()), format!("the replier takes `{request}` and answers `{reply}`"))
        .label(asked.0.span().to(asked.1.span()), "the requester has them the other way round")
        .note("on both ends the left type is what the `req` gate sends")
}

#[cfg(test)]
mod tests {
    use super::{REPLIES_DIFFER, REQUESTS_DIFFER, SWAPPED_TYPES};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn request_types_differ() {
        rule_example(
            &REQUESTS_DIFFER,
            expect![[r#"
                error: [SCL0602] the request types of this connection differ
                 --> topology.yaml:9:5
                  |
                4 |       - commands: {rep: Command -> Status}
                  |                         ------- the replier understands this
                ...
                7 |       - commands: {req: Cmd -> Status}
                  |                         --- the requester sends this
                8 | connections:
                9 |   - [controller.commands, ui.commands]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `Cmd` is asked, `Command` is understood
                  |
                  = help: write `Command -> Status` at `ui.commands`
                  = help: write `Cmd -> Status` at `controller.commands`
                  = note: the reply types agree (`Status`)
            "#]],
        );
    }

    #[test]
    fn reply_types_differ() {
        rule_example(
            &REPLIES_DIFFER,
            expect![[r#"
                error: [SCL0603] the reply types of this connection differ
                 --> topology.yaml:9:5
                  |
                4 |       - commands: {rep: Command -> Status}
                  |                                    ------ the replier answers this
                ...
                7 |       - commands: {req: Command -> Ack}
                  |                                    --- the requester expects this
                8 | connections:
                9 |   - [controller.commands, ui.commands]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `Status` is answered, `Ack` is expected
                  |
                  = help: write `Command -> Status` at `ui.commands`
                  = help: write `Command -> Ack` at `controller.commands`
                  = note: the request types agree (`Command`)
            "#]],
        );
    }

    #[test]
    fn request_and_reply_swapped() {
        rule_example(
            &SWAPPED_TYPES,
            expect![[r#"
                error: [SCL0604] request and reply types are swapped on one end
                 --> topology.yaml:9:5
                  |
                4 |       - commands: {rep: Command -> Status}
                  |                         ----------------- the replier takes `Command` and answers `Status`
                ...
                7 |       - commands: {req: Status -> Command}
                  |                         ----------------- the requester has them the other way round
                8 | connections:
                9 |   - [controller.commands, ui.commands]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
                  |
                  = help: write `Command -> Status` at `ui.commands`
                  = help: write `Status -> Command` at `controller.commands`
                  = note: on both ends the left type is what the `req` gate sends
            "#]],
        );
    }
}
