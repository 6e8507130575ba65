//! Characters that look like ASCII characters but are not: marks of word processors, letters of other scripts.

/// What each character is called, and the mark it is taken for.
const MARKS: [(char, &str, &str); 49] = [
    ('：', "a fullwidth colon", ":"),
    ('，', "a fullwidth comma", ","),
    ('、', "an ideographic comma", ","),
    ('؛', "an Arabic semicolon", ","),
    ('；', "a fullwidth semicolon", ","),
    ('．', "a fullwidth full stop", "."),
    ('。', "an ideographic full stop", "."),
    ('·', "a middle dot", "."),
    ('［', "a fullwidth bracket", "["),
    ('］', "a fullwidth bracket", "]"),
    ('【', "a black bracket", "["),
    ('】', "a black bracket", "]"),
    ('｛', "a fullwidth brace", "{"),
    ('｝', "a fullwidth brace", "}"),
    ('＃', "a fullwidth number sign", "#"),
    ('＿', "a fullwidth low line", "_"),
    ('“', "a curly quote", "\""),
    ('”', "a curly quote", "\""),
    ('„', "a low quote", "\""),
    ('«', "an angle quote", "\""),
    ('»', "an angle quote", "\""),
    ('‘', "a curly quote", "'"),
    ('’', "a curly quote", "'"),
    ('＂', "a fullwidth quote", "\""),
    ('‐', "a typographic hyphen", "-"),
    ('‑', "a non-breaking hyphen", "-"),
    ('–', "an en dash", "-"),
    ('—', "an em dash", "-"),
    ('−', "a minus sign", "-"),
    ('‒', "a figure dash", "-"),
    ('―', "a horizontal bar", "-"),
    ('─', "a line of a box", "-"),
    ('➜', "an arrow", "->"),
    ('⟶', "a long arrow", "->"),
    ('➔', "an arrow", "->"),
    ('‣', "a bullet", "-"),
    ('－', "a fullwidth hyphen", "-"),
    ('•', "a bullet", "-"),
    ('●', "a bullet", "-"),
    ('◦', "a bullet", "-"),
    ('▪', "a bullet", "-"),
    ('→', "an arrow", "->"),
    ('⇒', "a double arrow", "->"),
    ('꞉', "a letter colon", ":"),
    ('ﬀ', "a ligature", "ff"),
    ('ﬁ', "a ligature", "fi"),
    ('ﬂ', "a ligature", "fl"),
    ('ﬃ', "a ligature", "ffi"),
    ('ﬄ', "a ligature", "ffl"),
];

/// Letters and the ASCII letters that they are taken for.
const CYRILLIC: (&str, &str) = ("аеорсухіјѕһԁАВЕКМНОРСТУХЅІЈ", "aeopcyxijshdABEKMHOPCTYXSIJ");
const GREEK: (&str, &str) = ("ονικρυαΑΒΕΖΗΙΚΜΝΟΡΤΥΧ", "ovikpuaABEZHIKMNOPTYX");

/// The name of a character that looks like a mark of YAML, and the mark.
pub(crate) fn mark(letter: char) -> Option<(&'static str, &'static str)> {
    let (_, name, mark) = MARKS.iter().find(|(other, _, _)| *other == letter)?;
    Some((name, mark))
}

/// The script of a letter, and the ASCII letter that it is taken for.
pub(crate) fn twin(letter: char) -> Option<(&'static str, char)> {
    [("Cyrillic", CYRILLIC), ("Greek", GREEK)].into_iter().find_map(|(script, (letters, twins))| {
        let at = letters.chars().position(|other| other == letter)?;
        Some((script, twins.chars().nth(at)?))
    })
}

/// The first character in a text that looks like an ASCII character, with its place.
pub(crate) fn first(text: &str) -> Option<(usize, char)> {
    let is_other = |letter: char| !letter.is_ascii() && (mark(letter).is_some() || twin(letter).is_some());
    text.char_indices().find(|(_, letter)| is_other(*letter))
}

/// Replaces characters that look like ASCII characters by the ones that were meant.
pub(crate) fn retyped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match (letter.is_ascii(), mark(letter), twin(letter)) {
            (false, Some((_, mark)), _) => {
                out.push_str(mark);
                // Wide marks have their space built in.
                if matches!(mark, ":" | ",") && letters.peek().is_some_and(|next| !next.is_whitespace()) {
                    out.push(' ');
                }
            }
            (false, None, Some((_, twin))) => out.push(twin),
            _ => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{CYRILLIC, GREEK, first, retyped};

    #[test]
    fn each_letter_has_its_twin() {
        for (letters, twins) in [CYRILLIC, GREEK] {
            assert_eq!(letters.chars().count(), twins.chars().count());
            assert_eq!(retyped(letters), twins);
        }
    }

    #[test]
    fn other_letters_stay() {
        assert_eq!(retyped("höhe：“сensor”→x"), "höhe: \"censor\"->x");
        assert_eq!(first("höhe，"), Some((5, '，')));
        assert_eq!(first("höhe"), None);
    }
}
