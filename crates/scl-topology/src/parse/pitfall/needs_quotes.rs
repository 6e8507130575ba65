//! SCL0130: a text that YAML cannot read without quotes, or not in the quotes that it has.

use super::scan;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::source::{SourceFile, Span};
use crate::yaml::SyntaxError;
use std::ops::Range;

/// SCL0130.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0130",
    severity: Severity::Error,
    title: "text that needs quotes",
    explanation: "YAML gives some characters a meaning even inside a sentence: `: ` starts a value, ` #` a comment, and \
                  a text cannot begin with `[`, `{`, `@`, `*` or `%`. In double quotes, `\\` starts an escape, and a \
                  second quote ends the text. Put the whole text in quotes that it does not contain.",
    example: " components:
   - name: controller
-    doc: Controller: steers the rover.
+    doc: \"Controller: steers the rover.\"
     gates: []
",
};

/// The key whose value is a sentence.
pub(in crate::parse) const KEY: &str = "doc";

/// Characters that cannot start a text without quotes.
const RESERVED: &str = "[]{}*&!|>%@`,?#";

/// Quotes that a text may stand in, also those of word processors, with the ones that close it.
const QUOTES: [(char, char); 8] =
    [('"', '"'), ('\'', '\''), ('`', '`'), ('“', '”'), ('„', '“'), ('‘', '’'), ('«', '»'), ('»', '«')];

/// Maximum length of a text that a help repeats, in characters.
const MOST_SHOWN: usize = 160;

/// The problem of a text, with the text in the right quotes as its proposal.
pub(in crate::parse) fn diagnose(value: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let written = &text[value.clone()];
    let (message, at, label) = cause(written);
    let span = source.span(value.start + at.start..value.start + at.end);
    RULE.at(message, span, label).help(words(&quoted(written)))
}

/// Whether a text, as it is written, has something in it that quotes would change.
pub(in crate::parse) fn is_needed(written: &str, in_brackets: bool) -> bool {
    written.starts_with(['"', '\''])
        || written.starts_with("- ")
        || written.starts_with(|first| RESERVED.contains(first))
        || written.ends_with(':')
        || [": ", ":\n", " #"].iter().any(|mark| written.contains(mark))
        || in_brackets && written.contains(['[', ']', '{', '}', ','])
}

/// The problem of an alias, an anchor or a tag that begins the value of `doc`.
pub(in crate::parse) fn at_start(at: Span, source: &SourceFile) -> Option<Diagnostic> {
    let text = source.text();
    let start = at.start as usize;
    let line = source.line_range(start);
    let key = text[line.start..start].trim_end().strip_suffix(':')?;
    if key.rsplit([' ', '{', ',']).next() != Some(KEY) {
        return None;
    }
    let rest = text[start..line.end].trim_end();
    let length = if key.contains('{') { length_in_braces(rest) } else { rest.len() };
    let value = start..start + rest[..length].trim_end().len();
    let quoted = vec![Edit::new(source.span(value.clone()), quoted(&text[value.clone()]))];
    Some(diagnose(&value, text, source).carry(quoted, true))
}

/// A backslash in double quotes at which the parser stops.
pub(in crate::parse) fn bad_escape(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let ranges = scan::scan(text).quoted;
    let range = ranges.get(ranges.partition_point(|range| range.start <= error.at).checked_sub(1)?)?.clone();
    let written = text.get(range.clone()).filter(|written| written.starts_with('"') && !written.contains('\n'))?;
    let at = unknown_escape(written).filter(|_| error.at <= range.end)?;
    let escape: String = written[at..].chars().take(2).collect();
    let plain = quoted(written);
    // Another one may be meant as an escape.
    let is_certain = !["\\n", "\\t", "\\\\", "\\\""].iter().any(|escape| written.contains(escape));
    let span = source.span(range.start + at..range.start + at + escape.len());
    let problem = RULE
        .at(format!("`{escape}` in double quotes starts an escape"), span, "no escape that YAML knows")
        .help(format!("write `{plain}`: in single quotes, a backslash has no meaning"));
    Some(problem.carry(vec![Edit::new(source.span(range), plain)], is_certain))
}

/// The first escape in a text that YAML does not know.
fn unknown_escape(written: &str) -> Option<usize> {
    let mut letters = written.char_indices();
    while let Some((at, letter)) = letters.next() {
        let Some((_, kind)) = (letter == '\\').then(|| letters.next()).flatten() else { continue };
        let digits = match kind {
            'x' => 2,
            'u' => 4,
            'U' => 8,
            other if "0abtnvfre \"/\\N_LP\t".contains(other) => 0,
            _ => return Some(at),
        };
        let mut hex = written[at + 2..].chars().take(digits);
        if digits > 0 && (written.len() < at + 2 + digits || !hex.all(|digit| digit.is_ascii_hexdigit())) {
            return Some(at);
        }
    }
    None
}

/// A text behind the `|` or `>` that begins a text on the next line.
pub(in crate::parse) fn behind_mark(value: &Range<usize>, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let written = &text[value.clone()];
    let rest = written.strip_prefix(['|', '>']).filter(|rest| rest.starts_with(' '))?.trim_start();
    let mark = &written[..1];
    let line = source.line_range(value.start);
    let before = &text[line.start..value.start];
    let in_braces = before.contains('{');
    let problem = RULE.at(
        format!("after `{mark}`, a text begins on the next line"),
        source.span(value.start..value.start + 1),
        "has a meaning in YAML",
    );
    let start = value.end - rest.len();
    let plain = match is_needed(rest, in_braces) {
        true => quoted(rest),
        false => rest.to_owned(),
    };
    let removed = Edit::new(source.span(value.clone()), plain);
    let problem = problem.suggest(format!("remove `{mark}`"), [removed]);
    if in_braces {
        return Some(problem);
    }
    let below = text[line.end..].lines().nth(1).filter(|_| rest.contains('\n')).unwrap_or("");
    let column = match below.len() - below.trim_start_matches(' ').len() {
        0 => before.len() - before.trim_start_matches([' ', '-']).len() + 2,
        column => column,
    };
    let moved = Edit::new(source.span(value.start + 1..start), format!("\n{}", " ".repeat(column)));
    let key = before.trim_start_matches([' ', '-']);
    Some(problem.suggest(format!("end the line after `{key}{mark}`, and write the text below it"), [moved]))
}

/// The length of a text in braces: up to the next key, or to the closing bracket.
fn length_in_braces(rest: &str) -> usize {
    let is_before_key =
        |at: &usize| rest[at + 1..].trim_start().split(' ').next().is_some_and(|word| word.ends_with(':'));
    let key = rest.match_indices(',').map(|(at, _)| at).find(is_before_key);
    key.or_else(|| rest.rfind(['}', ']'])).unwrap_or(rest.len())
}

/// What to write, for a text in the right quotes.
pub(super) fn words(quoted: &str) -> String {
    match quoted.contains('\n') || quoted.chars().count() > MOST_SHOWN {
        true => "put the whole text in quotes".to_owned(),
        false => format!("put the whole text in quotes: `{KEY}: {quoted}`"),
    }
}

/// What a reader of YAML stumbles over, where in the text, and a label.
fn cause(written: &str) -> (String, Range<usize>, &'static str) {
    let first = written.chars().next().unwrap_or(' ');
    if matches!(first, '"' | '\'') {
        return match end_of_quoted(written, first).filter(|end| end + 1 < written.len()) {
            Some(end) => (format!("this `{first}` ends the text"), end..end + 1, "the text ends here"),
            None => {
                let at = written.find('\\').unwrap_or(0);
                ("a backslash in double quotes starts an escape".to_owned(), at..at + 1, "no escape that YAML knows")
            }
        };
    }
    if RESERVED.contains(first) || written.starts_with("- ") {
        let message = format!("a text cannot start with {} unless it is in quotes", ticked(first));
        return (message, 0..first.len_utf8(), "has another meaning in YAML");
    }
    let colon = written.find(": ").or_else(|| written.ends_with(':').then(|| written.len() - 1));
    if let Some(at) = colon {
        return ("a text with `: ` in it needs quotes".to_owned(), at..at + 1, "YAML takes this for the end of a key");
    }
    if let Some(at) = written.find(" #") {
        return ("a text with ` #` in it needs quotes".to_owned(), at + 1..at + 2, "YAML takes the rest for a comment");
    }
    match written.find(['[', ']', '{', '}', ',']) {
        Some(at) => {
            let message = format!("a text in braces with `{}` in it needs quotes", &written[at..at + 1]);
            (message, at..at + 1, "YAML takes this for a mark of its own")
        }
        None => ("this text needs quotes".to_owned(), 0..written.len(), ""),
    }
}

/// Where the quote that opens a text is closed.
fn end_of_quoted(written: &str, quote: char) -> Option<usize> {
    let mut letters = written.char_indices().skip(1).peekable();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '\\' if quote == '"' => drop(letters.next()),
            '\'' if quote == '\'' && letters.peek().is_some_and(|(_, next)| *next == '\'') => drop(letters.next()),
            _ if letter == quote => return Some(at),
            _ => {}
        }
    }
    None
}

/// A text, perhaps in the wrong quotes, in the right ones.
pub(in crate::parse) fn quoted(written: &str) -> String {
    let inner = written.chars().next().and_then(|quote| {
        let (_, end) = QUOTES.iter().find(|(start, _)| *start == quote)?;
        let inner = written[quote.len_utf8()..].strip_suffix(*end)?;
        let is_whole = matches!(quote, '"' | '\'') || !inner.contains([quote, *end]);
        is_whole.then(|| match quote {
            '"' => inner.replace("\\\"", "\"").replace("\\\\", "\\"),
            '\'' => inner.replace("\\'", "'").replace("''", "'"),
            _ => inner.to_owned(),
        })
    });
    let text = inner.unwrap_or_else(|| written.to_owned());
    match (text.contains(['"', '\\']), text.contains('\'')) {
        (false, _) => format!("\"{text}\""),
        (true, false) => format!("'{text}'"),
        (true, true) => format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"")),
    }
}

fn ticked(character: char) -> String {
    if character == '`' { "`` ` ``".to_owned() } else { format!("`{character}`") }
}

#[cfg(test)]
mod tests {
    use super::{RULE, quoted};
    use crate::advice::apply;
    use crate::parse::testing::{check, parse_text};
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0130] a text with `: ` in it needs quotes
             --> topology.yaml:3:20
              |
            3 |     doc: Controller: steers the rover.
              |                    ^ YAML takes this for the end of a key
              |
              = help: put the whole text in quotes: `doc: "Controller: steers the rover."`"#]],
        );
    }

    #[test]
    fn the_proposal_keeps_the_whole_text() {
        for (written, meant) in [
            ("Controller: steers", "Controller: steers"),
            ("\"Steers the \"rover\".\"", "Steers the \"rover\"."),
            ("'It's'", "It's"),
            ("[WIP] later", "[WIP] later"),
            ("{a} b", "{a} b"),
            ("\"C:\\specs\"", "C:\\specs"),
            ("@owner", "@owner"),
            ("*bold* word", "*bold* word"),
            ("*bold*", "*bold*"),
            ("!important", "!important"),
            ("%d", "%d"),
            ("- item", "- item"),
            ("`Steers`", "Steers"),
            ("“Controller: steers”", "Controller: steers"),
            ("„Controller: steers“", "Controller: steers"),
            ("“Controller”: “steers”", "“Controller”: “steers”"),
        ] {
            let block = format!("components:\n  - name: a\n    doc: {written}\n    gates: []\nconnections: []\n");
            let flow = format!("components:\n  - {{name: a, doc: {written}, gates: []}}\nconnections: []\n");
            for text in [block, flow] {
                let (_, problems, _) = parse_text(&text);
                assert!(problems.len() == 1 && problems[0].code() == RULE.code, "{text}\n{problems:?}");
                let edits: Vec<_> = problems[0].proposals().next().iter().flat_map(|way| &way.edits).collect();
                let (model, left, _) = parse_text(&apply(&text, &edits).unwrap_or_default());
                let doc = model.components.first().and_then(|component| component.doc.as_ref());
                assert_eq!((doc.map(|doc| doc.value.as_str()), left), (Some(meant), vec![]), "{text}");
            }
        }
    }

    #[test]
    fn a_missing_mark_is_no_text() {
        for written in ["Steers gates: []", "\"Steers"] {
            let text = format!("components:\n  - {{name: a, doc: {written}}}\nconnections: []\n");
            let (_, problems, _) = parse_text(&text);
            assert!(problems.iter().all(|problem| problem.code() != RULE.code), "{text}\n{problems:?}");
        }
    }

    #[test]
    fn quotes_fit_the_text() {
        for (written, meant) in [
            ("a: b", r#""a: b""#),
            ("it's: b", r#""it's: b""#),
            (r#"'it's'"#, r#""it's""#),
            (r"'it\'s'", r#""it's""#),
            (r#""the "rover".""#, r#"'the "rover".'"#),
            (r#""C:\specs""#, r"'C:\specs'"),
            (r#""the \"C:\specs\"""#, r#"'the "C:\specs"'"#),
            (r#""a" and 'b'"#, r#""\"a\" and 'b'""#),
        ] {
            assert_eq!(quoted(written), meant, "{written}");
        }
    }
}
