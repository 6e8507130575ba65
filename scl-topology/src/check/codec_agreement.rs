//! SCL0608: the two ends write and read bytes in different ways.

use super::codec_name::word;
use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::topology::GateKind;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    for (link, source, sink) in draft.flows() {
        let (Some(a), Some(b)) = (&draft.gates[source].codec, &draft.gates[sink].codec) else { continue };
        if a.value == b.value {
            continue;
        }
        let (a_word, b_word) = (word(&a.value), word(&b.value));
        let label = match draft.gates[source].kind {
            Some(GateKind::Req) => format!("the request is `{a_word}`, `{b_word}` is understood"),
            _ => format!("`{a_word}` is sent, `{b_word}` is expected"),
        };
        let headline = "the two ends of this connection use different codecs";
        let found = Diagnostic::error("SCL0608", headline, draft.links[link].model.span, label)
            .label(a.span, "")
            .label(b.span, "")
            .help("give both ends the same `codec`; an end without one takes the codec of the other");
        problems.push(found);
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn codecs_differ() {
        let yaml = r#"
components:
  - name: autopilot
    gates:
      - attitude: {pub: Attitude, codec: json}
  - name: blackbox
    gates:
      - attitude: {sub: Attitude, codec: cbor}
connections:
  - [autopilot.attitude, blackbox.attitude]
"#;
        example(
            "SCL0608",
            yaml.trim_start(),
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
              = help: give both ends the same `codec`; an end without one takes the codec of the other
        "#]],
        );
    }
}
