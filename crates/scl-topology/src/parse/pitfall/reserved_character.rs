//! SCL0106: a character that cannot start a value.

use super::dash;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::source::SourceFile;

/// SCL0106.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0106",
    severity: Severity::Error,
    title: "character that cannot start a value",
    explanation: "Some characters have a special meaning at the start of a value, such as `@`, `%`, `&` and `*`. \
                  Remove the character, or put the value in quotes.",
    example: " components:
-  - name: @sensor
+  - name: sensor
+    gates: []
",
};

/// The character at the place of the error, if a reserved one stands there.
pub(in crate::parse) fn find(at: usize, source: &SourceFile) -> Option<Diagnostic> {
    let character = source.text().get(at..)?.chars().next()?;
    matches!(character, '@' | '`' | '%' | '&' | '*' | '!').then(|| diagnose(at, character, source))
}

pub(in crate::parse) fn diagnose(at: usize, character: char, source: &SourceFile) -> Diagnostic {
    let text = source.text();
    let line = source.line_range(at);
    let is_first = text.get(line.start..at).is_some_and(|before| before.trim().is_empty());
    if is_first && text.get(at + 1..line.end).is_some_and(|rest| rest.starts_with(' ')) {
        return dash::other_mark(at, source).carry(vec![Edit::new(source.span(at..at + 1), "-")], true);
    }
    let rest = text.get(at..line.end).unwrap_or("");
    let span = source.span(at..at + rest.chars().next().map_or(0, char::len_utf8));
    let problem = RULE
        .at(format!("a value cannot start with {} in YAML", ticked(character)), span, "reserved character")
        .note("also reserved at the start: `` ` `` `%` `&` `*` `!` `|` `>` `'` `\"` `#`");
    if let Some(word) = rest.strip_prefix('`').and_then(|rest| rest.split_once('`')).map(|(word, _)| word) {
        let edit = Edit::new(source.span(at..at + word.len() + 2), word);
        return problem.propose(format!("write `{word}` without the backticks"), [edit]);
    }
    let word = rest.split([' ', ',', ']', '}']).next().unwrap_or(rest);
    let quoted = Edit::new(source.span(at..at + word.len()), format!("\"{word}\""));
    problem
        .suggest(format!("remove {}", ticked(character)), [Edit::new(span, "")])
        .suggest(format!("put the value in quotes: `\"{word}\"`"), [quoted])
        .otherwise("a value starts with a letter, a digit, a quote or a bracket")
}

fn ticked(character: char) -> String {
    if character == '`' { "`` ` ``".to_owned() } else { format!("`{character}`") }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
                error: [SCL0106] a value cannot start with `@` in YAML
                 --> topology.yaml:2:11
                  |
                2 |   - name: @sensor
                  |           ^ reserved character
                  |
                  = help: remove `@`
                  = help: put the value in quotes: `"@sensor"`
                  = note: also reserved at the start: `` ` `` `%` `&` `*` `!` `|` `>` `'` `"` `#`"#]],
        );
    }
}
