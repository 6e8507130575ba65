//! SCL0210: a gate without a name, as in `{pub: Fix, rate: 10Hz}`.

use super::gate::RULE;
use crate::diagnostic::{Diagnostic, Edit};
use crate::grammar::SHARED_GATE_KEYS;
use crate::parse::field::Field;
use crate::parse::words::{is_kind, is_like_option};
use crate::rust_name::gate_field;
use crate::source::{SourceFile, Span};
use crate::spelling::is_word;
use crate::suggest;

/// Whether a kind with a type stands where the name of a gate is expected, perhaps with options behind it.
pub(in crate::parse) fn is_nameless(fields: &[Field<'_>]) -> bool {
    let Some((first, others)) = fields.split_first() else { return false };
    let is_type = |text: &str| {
        let has_mark = text.contains(|letter: char| letter.is_ascii_uppercase() || matches!(letter, '.' | ':'));
        has_mark && suggest::kind(text).is_empty()
    };
    is_kind(first.key)
        && first.value.text().is_some_and(is_type)
        && others.iter().all(|other| is_like_option(other.key) || SHARED_GATE_KEYS.contains(&other.key))
}

/// The problem of such a gate, whose entries are at this place.
pub(in crate::parse) fn diagnose(fields: &[Field<'_>], at: Span, source: &SourceFile) -> Option<Diagnostic> {
    let first = fields.first()?;
    let problem = RULE.at("this gate has no name", first.key_span, "a kind, where the name is expected");
    let entries: Vec<&str> =
        fields.iter().map(|field| source.snippet(field.key_span.to(field.value.span)).trim()).collect();
    let gate = format!("{}: {{{}}}", example_name(first.value.text().unwrap_or_default()), entries.join(", "));
    let is_simple = !source.snippet(at).contains('#') && !gate.contains('\n');
    let problem = match is_simple {
        true => problem.suggest(format!("give it one: `{gate}`"), [Edit::new(at, gate)]),
        false => problem,
    };
    Some(problem.otherwise("a gate is written `name: {kind: type}`"))
}

/// A name that suits a type: `measurement` for `rover.Measurement`.
fn example_name(payload: &str) -> String {
    let request = payload.split("->").next().unwrap_or(payload).trim();
    let word = request.rsplit(['.', ':']).next().unwrap_or(request);
    if is_word(word) { gate_field(word) } else { "name".to_owned() }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::advice;
    use expect_test::expect;

    #[test]
    fn a_kind_in_the_place_of_a_name_is_told_once() {
        let gates = [
            "- {pub: rover.Fix, rate: 5Hz}",
            "- pub: Fix\n        codec: json",
            "- pub: Fix",
            "- req: Ask -> Answer",
            "- pub: Fix   # often\n        codec: json",
            "- pub: pubb",
            "- {pub: Fix, other: sub}",
        ];
        let told = gates.map(|gate| {
            let yaml = format!("components:\n  - name: a\n    gates:\n      {gate}\n");
            format!("{gate}\n    {}\n", advice(&yaml))
        });
        expect![[r#"
            - {pub: rover.Fix, rate: 5Hz}
                SCL0210 this gate has no name [give it one: `fix: {pub: rover.Fix, rate: 5Hz}`]
            - pub: Fix
                    codec: json
                SCL0210 this gate has no name [give it one: `fix: {pub: Fix, codec: json}`]
            - pub: Fix
                SCL0210 this gate has no name [give it one: `fix: {pub: Fix}`]
            - req: Ask -> Answer
                SCL0210 this gate has no name [a gate is written `name: {kind: type}`]
            - pub: Fix   # often
                    codec: json
                SCL0210 this gate has no name [a gate is written `name: {kind: type}`]
            - pub: pubb
                SCL0401 unknown gate kind `pubb` [the kind is called `pub`]
            - {pub: Fix, other: sub}
                SCL0401 unknown gate kind `Fix` []; SCL0210 two gates in one list item (`pub`, `other`) [each gate is an item of its own in the list]
        "#]].assert_eq(&told.concat());
    }
}
