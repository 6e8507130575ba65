//! SCL0407: a word that is no codec. Sets the codecs that gates name themselves.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::grammar::CodecRow;
use crate::habits;
use crate::rust_name::{is_keyword, is_unescapable};
use crate::source::Spanned;
use crate::spelling::is_word;
use crate::suggest::similar;
use crate::topology::Codec;

/// SCL0407.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0407",
    severity: Severity::Error,
    title: "unknown codec",
    explanation: "A codec turns messages into bytes; this one is unknown. The message lists the codecs of the \
                  framework. Name a codec of your own by its Rust path, such as `my_crate::Flat`.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: Measurement, codec: protobuff}
+      - measurements: {pub: Measurement, codec: protobuf}
",
};

/// Reads the codecs of the gates, and returns the codec of the whole file.
pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) -> Codec {
    for gate in &mut draft.gates {
        let Some(option) = gate.option("codec") else { continue };
        match codec_of(&option.value.value) {
            Some(codec) => gate.codec = Some(Spanned { value: codec, span: option.key.span.to(option.value.span) }),
            None => {
                gate.codec_broken = true;
                problems.push(report(&option.value));
            }
        }
    }
    let Some(written) = &draft.model.codec else { return Codec::DEFAULT };
    codec_of(&written.value).unwrap_or_else(|| {
        problems.push(report(written));
        Codec::DEFAULT
    })
}

fn codec_of(word: &str) -> Option<Codec> {
    Codec::of(word).or_else(|| is_rust_path(word).then(|| Codec::Path(word.to_owned())))
}

fn is_rust_path(text: &str) -> bool {
    let path = text.strip_prefix("::").unwrap_or(text);
    text.contains("::") && path.split("::").all(is_word) && keyword_in(text).is_none()
}

/// A keyword in a path at a place where Rust does not allow it.
fn keyword_in(text: &str) -> Option<&str> {
    let mut may_start = true;
    text.split("::").find(|&word| {
        let starts = may_start && (matches!(word, "self" | "super") || word == "crate" && text.starts_with("crate"));
        may_start = starts;
        !starts && (is_keyword(word) || is_unescapable(word))
    })
}

fn report(written: &Spanned<String>) -> Diagnostic {
    let headline = format!("unknown codec `{}`", written.value);
    let keyword = keyword_in(&written.value).filter(|_| written.value.contains("::"));
    let label = keyword.map_or_else(String::new, |word| format!("`{word}` is a keyword of Rust"));
    let found = RULE.at(headline, written.span, label);
    let path = written.value.contains('.').then(|| written.value.replace('.', "::")).filter(|path| is_rust_path(path));
    let habit = habits::CODECS.find(&written.value);
    let found = match habit {
        Some(habit) => habit.ways.iter().fold(found, |found, way| {
            found.suggest(format!("the nearest codec is `{way}`"), [Edit::new(written.span, *way)])
        }),
        None => found.did_you_mean(&written.value, &meant(&written.value)),
    };
    let found = match path {
        Some(path) => {
            let text = format!("a codec of your own is named by its Rust path: `{path}`");
            found.suggest(text, [Edit::new(written.span, path)])
        }
        None => found,
    };
    let words = habit.map(|habit| habit.text).filter(|text| !text.is_empty());
    found.otherwise(words.unwrap_or("a codec of your own is a type of a crate, named by its Rust path")).note(codecs())
}

/// The codecs that a word may mean: by another name, by a media type such as `application/x-protobuf`, or misspelt.
fn meant(written: &str) -> Vec<&'static str> {
    let lower = written.to_lowercase();
    // The part behind the slash, without its parameters: `x-protobuf`, `vnd.api+json`.
    let kind = lower.split_once('/').map_or(lower.as_str(), |(_, kind)| kind);
    let kind = kind.split(';').next().unwrap_or(kind).trim();
    let names = kind.split(['+', '.', ':']).rev().map(|name| name.trim_start_matches("x-").trim_start_matches("x."));
    for name in names {
        let compact = habits::compact(name);
        let is_called = |row: &&CodecRow| row.word == compact || row.synonyms.contains(&compact.as_str());
        if let Some(row) = Codec::BUILT_IN.iter().find(is_called) {
            return vec![row.word];
        }
    }
    similar(kind, Codec::words())
}

fn codecs() -> String {
    let default = Codec::DEFAULT;
    let words = Codec::words().map(|word| match default.word() == word {
        true => format!("`{word}` (default)"),
        false => format!("`{word}`"),
    });
    format!("codecs: {}", words.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn unknown_codec() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0407] unknown codec `protobuff`
             --> topology.yaml:4:49
              |
            4 |       - measurements: {pub: Measurement, codec: protobuff}
              |                                                 ^^^^^^^^^
              |
              = help: did you mean `protobuf`?
              = note: codecs: `protobuf` (default), `json`, `cbor`, `msgpack`, `postcard`, `raw`
        "#]],
        );
    }

    #[test]
    fn codecs_have_other_names() {
        let codecs =
            ["pb", "JSON", "messagepack", "my_crate.Flat", "xml", "my_crate::Flat", "crate::Flat", "fn::A", "a::self"];
        let advice = |codec: &str| {
            advice(&format!(
                "components:\n  - name: a\n    gates:\n      - x: {{pub: T, codec: '{codec}', unconnected: ok}}\n"
            ))
        };
        let told: String = codecs.iter().map(|codec| format!("{codec}: {}\n", advice(codec))).collect();
        expect![[r#"
            pb: SCL0407 unknown codec `pb` [did you mean `protobuf`?]
            JSON: SCL0407 unknown codec `JSON` [did you mean `json`?]
            messagepack: SCL0407 unknown codec `messagepack` [did you mean `msgpack`?]
            my_crate.Flat: SCL0407 unknown codec `my_crate.Flat` [a codec of your own is named by its Rust path: `my_crate::Flat`]
            xml: SCL0407 unknown codec `xml` [scl has no such codec; a codec of your own is a Rust type, named by its path]
            my_crate::Flat: 
            crate::Flat: 
            fn::A: SCL0407 unknown codec `fn::A` [a codec of your own is a type of a crate, named by its Rust path]
            a::self: SCL0407 unknown codec `a::self` [a codec of your own is a type of a crate, named by its Rust path]
        "#]].assert_eq(&told);
    }
}
