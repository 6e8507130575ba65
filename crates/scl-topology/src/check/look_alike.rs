//! SCL0304: a letter outside of ASCII. The parser reports those that look like an ASCII letter.

use super::named::{Noun, names};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Model;
use crate::source::Spanned;

pub(crate) use crate::parse::LETTER as RULE;

/// How people write these letters where a keyboard lacks them.
const TRANSLITERATIONS: [(&str, &str); 22] = [
    ("ä", "ae"),
    ("ö", "oe"),
    ("ü", "ue"),
    ("Ä", "Ae"),
    ("Ö", "Oe"),
    ("Ü", "Ue"),
    ("ß", "ss"),
    ("æ", "ae"),
    ("ø", "oe"),
    ("åàáâã", "a"),
    ("éèêë", "e"),
    ("íìîï", "i"),
    ("óòôõ", "o"),
    ("úùû", "u"),
    ("çćč", "c"),
    ("ñńň", "n"),
    ("šś", "s"),
    ("žźż", "z"),
    ("ýÿ", "y"),
    ("ł", "l"),
    ("ř", "r"),
    ("µμ", "u"),
];

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model) {
        if let Some(letter) = name.value.chars().find(|&letter| is_foreign(letter)) {
            problems.push(report(noun, name, letter));
        }
    }
}

pub(super) fn has_foreign_letter(name: &str) -> bool {
    name.chars().any(is_foreign)
}

fn is_foreign(letter: char) -> bool {
    !letter.is_ascii() && letter.is_alphabetic()
}

fn report(noun: Noun, name: &Spanned<String>, letter: char) -> Diagnostic {
    let code = u32::from(letter);
    let headline = format!(
        "{} name `{}` contains the letter `{letter}` (U+{code:04X}), which is not ASCII",
        noun.word(),
        name.value
    );
    let found = RULE.at(&*headline, name.span, "allowed: a-z A-Z 0-9 _ -").about(&*headline);
    let found = match retyped(&name.value) {
        Some(ascii) => found.help(format!("write `{ascii}`")),
        None => found.help("write the name in ASCII letters"),
    };
    found.note("names are ASCII, so that the file, the socket paths and all language bindings agree")
}

/// The name in ASCII, if each of its letters has a usual replacement.
fn retyped(name: &str) -> Option<String> {
    let mut out = String::new();
    for letter in name.chars() {
        match letter.is_ascii() {
            true => out.push(letter),
            false => out.push_str(TRANSLITERATIONS.iter().find(|(from, _)| from.contains(letter))?.1),
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn look_alike_character_in_a_name() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0304] component name `sеnsor` contains the Cyrillic letter `е` (U+0435), which looks like `e`
             --> topology.yaml:2:11
              |
            2 |   - name: sеnsor
              |           ^^^^^^ not the Latin `e`
              |
              = help: retype the name in ASCII: `sensor`
              = note: names are ASCII, so that the file, the socket paths and all language bindings agree
        "#]],
        );
    }

    #[test]
    fn other_letters_have_usual_replacements() {
        let names = ["höhensensor", "Größe", "φ", "cafés", "αx"];
        let advice = |name: &str| advice(&format!("components:\n  - name: {name}\n    gates: []\n"));
        let told: String = names.iter().map(|name| format!("{}\n", advice(name))).collect();
        expect![[r#"
            SCL0304 component name `höhensensor` contains the letter `ö` (U+00F6), which is not ASCII [write `hoehensensor`]
            SCL0304 component name `Größe` contains the letter `ö` (U+00F6), which is not ASCII [write `Groesse`]
            SCL0304 component name `φ` contains the letter `φ` (U+03C6), which is not ASCII [write the name in ASCII letters]
            SCL0304 component name `cafés` contains the letter `é` (U+00E9), which is not ASCII [write `cafes`]
            SCL0304 component name `αx` contains the Greek letter `α` (U+03B1), which looks like `a` [retype the name in ASCII: `ax`]
        "#]].assert_eq(&told);
    }
}
