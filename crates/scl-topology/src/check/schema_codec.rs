//! SCL0412: a codec that cannot carry a message of the schemas. Gates with the same codec are reported together.

use super::draft::{Draft, DraftGate};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::Span;
use crate::topology::{Codec, Payload, TypeName};
use scl_text::list::listed;
use std::collections::BTreeMap;

/// SCL0412.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0412",
    severity: Severity::Error,
    title: "codec cannot carry a message of the schemas",
    explanation: "A message of the `schemas` has two encodings, which are the same in every language: `protobuf`, and \
                  `json` in protobuf's canonical form. `cbor`, `msgpack` and `postcard` encode Rust types with serde's \
                  traits, and `raw` encodes Rust types of fixed layout. Use one of the two, or a Rust type of your own.",
    example: " schemas: [uav.proto]
 components:
   - name: sensor
     gates:
-      - measurements: {pub: uav.Measurement, codec: cbor}
+      - measurements: {pub: uav.Measurement, codec: json}
",
};

/// Gates by the place and the word of their codec.
type ByCodec<'d> = BTreeMap<Span, (&'d str, Vec<usize>)>;

pub(super) fn check(draft: &Draft<'_>, file_codec: &Codec, problems: &mut Diagnostics) {
    let mut by_codec = ByCodec::new();
    for (at, gate) in draft.gates.iter().enumerate() {
        if let Some((span, word)) = codec_of(draft, gate, file_codec)
            && schema_type(gate).is_some()
        {
            by_codec.entry(span).or_insert((word, Vec::new())).1.push(at);
        }
    }
    problems.extend(by_codec.into_iter().map(|(span, (word, gates))| report(draft, span, word, &gates)));
}

/// Where a gate's codec is written and its word, if the codec carries Rust types only.
fn codec_of<'d>(draft: &'d Draft<'_>, gate: &'d DraftGate<'_>, file_codec: &'d Codec) -> Option<(Span, &'d str)> {
    let (span, codec) = match (&gate.codec, &draft.model.codec) {
        _ if gate.codec_broken => return None,
        (Some(own), _) => (own.span, &own.value),
        (None, Some(of_file)) => (of_file.span, file_codec),
        (None, None) => return None,
    };
    (!codec.carries_schema_types()).then(|| (span, codec.word()))
}

fn schema_type<'d>(gate: &'d DraftGate<'_>) -> Option<&'d TypeName> {
    gate.payload.as_ref().map(Payload::types)?.into_iter().find(|name| name.in_schemas())
}

fn report(draft: &Draft<'_>, codec: Span, word: &str, gates: &[usize]) -> Diagnostic {
    let first = gates.first().and_then(|&gate| schema_type(&draft.gates[gate]));
    let dotted = first.map_or("", TypeName::dotted);
    let headline = format!("the codec `{word}` cannot carry `{dotted}`, a message of the `schemas`");
    let ways = ["protobuf", "json"];
    let replaced = |way: &str| match draft.sources.snippet(codec).starts_with("codec") {
        true => format!("codec: {way}"),
        false => draft.sources.quoted_as(codec, way),
    };
    let found = RULE
        .at(headline, codec, "carries Rust types only")
        .labels(first.map(|name| (name.span(), "a message of the `schemas`")))
        .choose(
            ("write ", " (protobuf's canonical JSON)"),
            ways.into_iter().map(|way| (way, Edit::new(codec, replaced(way)))),
        )
        .otherwise("messages of the `schemas` have the codec `protobuf` (the default) or `json`");
    match gates.len() {
        0 | 1 => found,
        _ => found.note(format!("gates with this codec: {}", listed(gates.iter().map(|&gate| draft.path(gate))))),
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{example_with, problems, rule_example_with};
    use expect_test::expect;

    #[test]
    fn codec_cannot_carry_a_message_of_the_schemas() {
        rule_example_with(
            &RULE,
            Some(&["uav.Measurement"]),
            expect![[r#"
                error: [SCL0412] the codec `cbor` cannot carry `uav.Measurement`, a message of the `schemas`
                 --> topology.yaml:5:46
                  |
                5 |       - measurements: {pub: uav.Measurement, codec: cbor}
                  |                             ---------------  ^^^^^^^^^^^ carries Rust types only
                  |                             |
                  |                             a message of the `schemas`
                  |
                  = help: write `protobuf` or `json` (protobuf's canonical JSON)
            "#]],
        );
    }

    #[test]
    fn gates_with_the_codec_of_the_file_are_reported_together() {
        let yaml = "
schemas: [uav.proto]
codec: raw
components:
  - name: sensor
    gates:
      - measurements: {pub: uav.Measurement}
      - image: {pub: camera.Image, unconnected: ok}
      - text: {pub: uav.Measurement, codec: json, unconnected: ok}
  - name: pilot
    gates:
      - sensor: sub
      - commands: {rep: camera.Image -> uav.Measurement, unconnected: ok}
connections:
  - [sensor.measurements, pilot.sensor]
";
        example_with(
            RULE.code,
            yaml.trim_start(),
            Some(&["uav.Measurement"]),
            expect![[r#"
                error: [SCL0412] the codec `raw` cannot carry `uav.Measurement`, a message of the `schemas`
                 --> topology.yaml:2:8
                  |
                2 | codec: raw
                  |        ^^^ carries Rust types only
                ...
                6 |       - measurements: {pub: uav.Measurement}
                  |                             --------------- a message of the `schemas`
                  |
                  = help: write `protobuf` or `json` (protobuf's canonical JSON)
                  = note: gates with this codec: `sensor.measurements`, `pilot.sensor`, `pilot.commands`
            "#]],
        );
    }

    #[test]
    fn each_codec_carries_what_it_can() {
        let found = |codec: &str, message: &str| {
            let yaml = format!(
                "schemas: [uav.proto]\ncomponents:\n  - name: a\n    gates:\n      \
                 - x: {{pub: {message}, codec: '{codec}', unconnected: ok}}\n"
            );
            problems(&yaml, Some(&["uav.Fix"])).0.iter().any(|found| found.code() == RULE.code)
        };
        for codec in ["raw", "postcard", "cbor", "msgpack"] {
            assert!(found(codec, "uav.Fix") && !found(codec, "gps.Position"), "{codec}");
        }
        for codec in ["protobuf", "json", "my_crate::Flat"] {
            assert!(!found(codec, "uav.Fix"), "{codec}");
        }
    }
}
