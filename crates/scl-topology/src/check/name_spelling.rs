//! How names are spelt. SCL0303: a character that no name may contain: names become socket paths, Rust names and words
//! of other languages. SCL0304: a letter outside of ASCII; the parser reports those that look like an ASCII letter.
//! SCL0305: a name that starts with a digit or a hyphen, which no programming language can spell.

use super::named::{Noun, names};
use super::rename::Renames;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::parse::{FILL_IN, placeholder};
use crate::source::Spanned;
use crate::spelling::{is_allowed, may_start};

pub(crate) use crate::parse::LETTER;

/// SCL0303.
pub(crate) const CHARACTERS: Rule = Rule {
    code: "SCL0303",
    severity: Severity::Error,
    title: "invalid character in a name",
    explanation: "Names become socket paths, Rust fields and names in other languages, so they consist of letters, \
                  digits, `_` and `-`. A dot separates component and gate, and the names of groups from what is in \
                  them, as in `left_arm.planner`.",
    example: " components:
-  - name: gps sensor
+  - name: gps_sensor
+    gates: []
",
};

pub(super) fn check<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    for (noun, name) in names(model) {
        if let Some(what) = forbidden(noun, &name.value) {
            problems.push(wrong_character(renames, noun, name, &what));
        }
        if let Some(letter) = name.value.chars().find(|&letter| is_foreign(letter)) {
            problems.push(foreign_letter(renames, noun, name, letter));
        }
        let is_spelt = noun
            .words(&name.value)
            .all(|word| !word.is_empty() && word.chars().all(is_allowed) && !word.contains("--"));
        if let Some(word) = noun.words(&name.value).find(|word| is_spelt && !word.starts_with(may_start)) {
            problems.push(wrong_start(renames, noun, name, word));
        }
    }
}

/// What the name must not contain, in words.
fn forbidden(noun: Noun, name: &str) -> Option<String> {
    if name.is_empty() || name.chars().any(is_foreign) {
        return None;
    }
    // A dot stands between the names of groups and that of the component.
    let may_have_dots = noun.may_have_group() && name.split('.').all(|word| !word.is_empty());
    match name.chars().find(|&letter| !(is_allowed(letter) || may_have_dots && letter == '.')) {
        Some(letter) => Some(described(letter)),
        None => name.contains("--").then(|| "two hyphens in a row".to_owned()),
    }
}

fn described(letter: char) -> String {
    match letter {
        ' ' => "a space".to_owned(),
        '.' => "a dot".to_owned(),
        '/' => "a slash".to_owned(),
        ':' => "a colon".to_owned(),
        '`' => "a backtick".to_owned(),
        other if other.is_control() => format!("a control character (U+{:04X})", u32::from(other)),
        other => format!("`{other}`"),
    }
}

fn wrong_character<'m>(renames: &Renames<'m>, noun: Noun, name: &'m Spanned<String>, what: &str) -> Diagnostic {
    let headline = format!("a {} name cannot contain {what}", noun.word());
    let found = CHARACTERS.at(headline, name.span, "allowed: a-z A-Z 0-9 _ -");
    let mended = mended(&name.value);
    let mut found = match mended.is_empty() {
        _ if placeholder(&name.value).is_some() => return found.help(format!("this is a placeholder: {FILL_IN}")),
        true => found,
        false => found.propose(format!("write `{mended}`"), renames.edits(noun, name, &mended)),
    };
    // A path or a pattern is rather something else than a misspelt name, and a dot may stand for another letter.
    let is_spelling = name.value.chars().all(|letter| is_allowed(letter) || letter == ' ');
    if !is_spelling {
        found.doubt();
    }
    match noun {
        Noun::System => found,
        _ if what.starts_with("two") => found.note("`--` separates the two ends in the name of a socket"),
        _ if noun.may_have_group() => {
            found.note("a dot separates the name of a group from what is in it: `left_arm.planner`")
        }
        _ => {
            found.note("the dot separates component and gate in `component.gate`, so a name cannot contain one either")
        }
    }
}

/// Joins the runs of ASCII letters and digits of a name with single `_`.
fn mended(name: &str) -> String {
    let words = name.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let joined = words.collect::<Vec<_>>().join("_");
    // A title, such as `Signal Detector`, has capitals that a name does not need.
    if name.contains(' ') { joined.to_ascii_lowercase() } else { joined }
}

/// The usual ASCII replacements of letters that a keyboard may lack.
const TRANSLITERATIONS: [(&str, &str); 21] = [
    ("äæ", "ae"),
    ("öø", "oe"),
    ("ü", "ue"),
    ("Ä", "Ae"),
    ("Ö", "Oe"),
    ("Ü", "Ue"),
    ("ß", "ss"),
    ("åàáâã", "a"),
    ("éèêë", "e"),
    ("íìîï", "i"),
    ("óòôõ", "o"),
    ("úùûµμ", "u"),
    ("çćč", "c"),
    ("ñńň", "n"),
    ("šś", "s"),
    ("žźż", "z"),
    ("ýÿ", "y"),
    ("ł", "l"),
    ("ř", "r"),
    ("ﬁ", "fi"),
    ("ﬂ", "fl"),
];

fn is_foreign(letter: char) -> bool {
    !letter.is_ascii() && letter.is_alphabetic()
}

fn foreign_letter<'m>(renames: &Renames<'m>, noun: Noun, name: &'m Spanned<String>, letter: char) -> Diagnostic {
    let code = u32::from(letter);
    let headline = format!(
        "{} name `{}` contains the letter `{letter}` (U+{code:04X}), which is not ASCII",
        noun.word(),
        name.value
    );
    let found = LETTER
        .at(&*headline, name.span, "allowed: a-z A-Z 0-9 _ -")
        .about(&*headline)
        .note("names are ASCII, so that the file, the socket paths and all language bindings agree");
    match retyped(&name.value) {
        Some(name_in_ascii) => {
            let edits = renames.edits(noun, name, &name_in_ascii);
            found.propose(format!("write `{name_in_ascii}`"), edits)
        }
        None => found.help("a name consists of ASCII letters, digits, `_` and `-`"),
    }
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

/// SCL0305.
pub(crate) const START: Rule = Rule {
    code: "SCL0305",
    severity: Severity::Error,
    title: "name starts with the wrong character",
    explanation: "A name starts with a letter or `_`, as in every programming language that will use it. Put a word \
                  first.",
    example: " components:
-  - name: 2nd_sensor
+  - name: second_sensor
+    gates: []
",
};

const ORDINALS: [(&str, &str); 9] = [
    ("1st", "first"),
    ("2nd", "second"),
    ("3rd", "third"),
    ("4th", "fourth"),
    ("5th", "fifth"),
    ("6th", "sixth"),
    ("7th", "seventh"),
    ("8th", "eighth"),
    ("9th", "ninth"),
];

fn wrong_start<'m>(renames: &Renames<'m>, noun: Noun, name: &'m Spanned<String>, word: &str) -> Diagnostic {
    let headline = format!("a {} name must start with a letter or `_`", noun.word());
    let start = if word.starts_with('-') { "starts with a hyphen" } else { "starts with a digit" };
    let ways: Vec<String> = alternatives(word).iter().map(|other| name.value.replacen(word, other, 1)).collect();
    let found = START.at(headline, name.span, start).otherwise("choose another name");
    let edits = |way: &str| renames.edits(noun, name, way);
    let mut found = found.choose_all(("write ", ""), ways.iter().map(|way| (way.as_str(), edits(way))));
    found.doubt();
    found
}

/// Suggests other names: `2nd_sensor` could be `second_sensor` or `sensor_2`.
fn alternatives(name: &str) -> Vec<String> {
    let digits: String = name.chars().take_while(char::is_ascii_digit).collect();
    let ordinal = ORDINALS.iter().find(|(short, _)| name.starts_with(short));
    // Of `2m-radio`, the whole first word.
    let first = name.find(['_', '-']).filter(|at| *at > 0 && ordinal.is_none()).unwrap_or(digits.len());
    let rest = ordinal.map_or(&name[first..], |(short, _)| &name[short.len()..]);
    let rest = rest.trim_matches(['_', '-']);
    let first = if ordinal.is_some() { digits.as_str() } else { &name[..first] };
    let moved = match (rest.is_empty(), first.is_empty()) {
        (true, _) => return Vec::new(),
        (false, true) => rest.to_owned(),
        (false, false) => format!("{rest}_{first}"),
    };
    let word = ordinal.map(|(_, word)| format!("{word}_{rest}"));
    word.into_iter().chain([moved]).collect()
}

#[cfg(test)]
mod tests {
    use super::{CHARACTERS, LETTER, START};
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn invalid_character_in_a_name() {
        rule_example(
            &CHARACTERS,
            expect![[r#"
                error: [SCL0303] a component name cannot contain a space
                 --> topology.yaml:2:11
                  |
                2 |   - name: gps sensor
                  |           ^^^^^^^^^^ allowed: a-z A-Z 0-9 _ -
                  |
                  = help: write `gps_sensor`
                  = note: a dot separates the name of a group from what is in it: `left_arm.planner`
            "#]],
        );
    }

    #[test]
    fn other_characters() {
        let names = ["a.b", "a/b", "a--b", "a+b!", "a:b"];
        let advice = |name: &str| advice(&format!("components:\n  - name: '{name}'\n    gates: []\n"));
        let told: String = names.iter().map(|name| format!("{}\n", advice(name))).collect();
        expect![[r#"

            SCL0303 a component name cannot contain a slash [write `a_b`]
            SCL0303 a component name cannot contain two hyphens in a row [write `a_b`]
            SCL0303 a component name cannot contain `+` [write `a_b`]
            SCL0303 a component name cannot contain a colon [write `a_b`]
        "#]]
        .assert_eq(&told);
    }

    #[test]
    fn look_alike_character_in_a_name() {
        rule_example(
            &LETTER,
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
            SCL0304 component name `φ` contains the letter `φ` (U+03C6), which is not ASCII [a name consists of ASCII letters, digits, `_` and `-`]
            SCL0304 component name `cafés` contains the letter `é` (U+00E9), which is not ASCII [write `cafes`]
            SCL0304 component name `αx` contains the Greek letter `α` (U+03B1), which looks like `a` [retype the name in ASCII: `ax`]
        "#]].assert_eq(&told);
    }

    #[test]
    fn name_starts_with_the_wrong_character() {
        rule_example(
            &START,
            expect![[r#"
                error: [SCL0305] a component name must start with a letter or `_`
                 --> topology.yaml:2:11
                  |
                2 |   - name: 2nd_sensor
                  |           ^^^^^^^^^^ starts with a digit
                  |
                  = help: write `second_sensor` or `sensor_2`
            "#]],
        );
    }

    #[test]
    fn other_starts() {
        let names = ["3sensors", "4", "-left", "1st-row", "2m-radio", "3_axes"];
        let advice = |name: &str| advice(&format!("components:\n  - name: '{name}'\n    gates: []\n"));
        let told: String = names.iter().map(|name| format!("{}\n", advice(name))).collect();
        expect![[r#"
            SCL0305 a component name must start with a letter or `_` [write `sensors_3`]
            SCL0305 a component name must start with a letter or `_` [choose another name]
            SCL0305 a component name must start with a letter or `_` [write `left`]
            SCL0305 a component name must start with a letter or `_` [write `first_row` or `row_1`]
            SCL0305 a component name must start with a letter or `_` [write `radio_2m`]
            SCL0305 a component name must start with a letter or `_` [write `axes_3`]
        "#]]
        .assert_eq(&told);
    }
}
