//! SCL0608: the two ends write and read bytes in different ways.

use super::draft::Draft;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::topology::{GateKind, Payload};

/// SCL0608.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0608",
    severity: Severity::Error,
    title: "codecs differ",
    explanation: "The two ends encode messages in different ways, so neither could read the other's. Give both the \
                  same `codec`; an end without one takes that of the other.",
    example: " components:
   - name: autopilot
     gates:
       - attitude: {pub: Attitude, codec: json}
   - name: blackbox
     gates:
-      - attitude: {sub: Attitude, codec: cbor}
+      - attitude: {sub: Attitude, codec: json}
 connections:
   - [autopilot.attitude, blackbox.attitude]
",
};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    for (link, source, sink) in draft.flows() {
        let (Some(a), Some(b)) = (&draft.gates[source].codec, &draft.gates[sink].codec) else { continue };
        // Untyped bytes are sent as they are, whatever the codec.
        let is_untyped = [source, sink].iter().any(|&gate| draft.gates[gate].payload == Some(Payload::Bytes));
        if a.value == b.value || is_untyped {
            continue;
        }
        let (a_word, b_word) = (a.value.word(), b.value.word());
        let label = match draft.gates[source].kind {
            Some(GateKind::Req) => format!("the request is `{a_word}`, `{b_word}` is understood"),
            _ => format!("`{a_word}` is sent, `{b_word}` is expected"),
        };
        let headline = "the two ends of this connection use different codecs";
        let found = RULE
            .at(headline, draft.links[link].model.span, label)
            .label(a.span, "")
            .label(b.span, "")
            .otherwise("both ends have one `codec`; an end without one takes the codec of the other");
        let found = [(sink, a_word), (source, b_word)].into_iter().fold(found, |found, (gate, word)| {
            match draft.gates[gate].option("codec") {
                Some(_) => {
                    let edit = draft.with_option(gate, "codec", word);
                    found.suggest(format!("write `codec: {word}` at `{}`", draft.path(gate)), [edit])
                }
                None => found,
            }
        });
        problems.push(found);
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn codecs_differ() {
        rule_example(
            &RULE,
            expect![[r#"
                error: [SCL0608] the two ends of this connection use different codecs
                 --> topology.yaml:9:5
                  |
                4 |       - attitude: {pub: Attitude, codec: json}
                  |                                   -----------
                ...
                7 |       - attitude: {sub: Attitude, codec: cbor}
                  |                                   -----------
                8 | connections:
                9 |   - [autopilot.attitude, blackbox.attitude]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `json` is sent, `cbor` is expected
                  |
                  = help: write `codec: json` at `blackbox.attitude`
                  = help: write `codec: cbor` at `autopilot.attitude`
            "#]],
        );
    }
}
