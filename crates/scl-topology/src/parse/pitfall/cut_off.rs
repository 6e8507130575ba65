//! SCL0133: a text that ends at a `#` that was probably meant as part of it.

use super::needs_quotes;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::source::{SourceFile, Span};
use crate::yaml::Node;

/// SCL0133.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0133",
    severity: Severity::Warning,
    title: "text that a comment cuts off",
    explanation: "A `#` after a space starts a comment, also in a sentence without quotes. Here a number follows the \
                  `#` at once, or a parenthesis is open before it, so the rest of the line was probably meant as part of \
                  the text. Put the text in quotes, or write a space after the `#`.",
    example: " components:
   - name: motors
-    doc: Drives motors #1 and #2.
+    doc: \"Drives motors #1 and #2.\"
     gates: []
",
};

/// Checks the value of `doc`.
pub(in crate::parse) fn find(value: &Node, source: &SourceFile) -> Option<Diagnostic> {
    let text = source.text();
    let (start, end) = (value.span.start as usize, value.span.end as usize);
    let rest = text.get(end..source.line_range(end).end)?;
    let comment = rest.trim_start().strip_prefix('#').filter(|_| value.is_plain())?;
    let written = source.snippet(value.span);
    let is_number = comment.starts_with(|first: char| first.is_ascii_digit());
    let is_open = written.matches('(').count() > written.matches(')').count() && comment.contains(')');
    if !(is_number || is_open) {
        return None;
    }
    let hash = end + rest.len() - rest.trim_start().len();
    let whole = start..end + rest.trim_end().len();
    let quoted = needs_quotes::quoted(&text[whole.clone()]);
    let space = source.span(hash + 1..hash + 1);
    let problem = RULE
        .at(
            "this `#` starts a comment, so the text ends before it",
            source.span(hash..hash + 1),
            "not part of the text",
        )
        .label(value.span, "the text")
        .suggest(needs_quotes::words(&quoted), [Edit::new(source.span(whole), quoted)]);
    Some(match is_number {
        true => problem.suggest("if it is a comment, write a space after `#`", [Edit::new(space, " ")]),
        false => problem,
    })
}

/// The value of `doc` as a list or mapping in one line, put in quotes.
pub(in crate::parse) fn as_text(problem: Diagnostic, value: Span, source: &SourceFile) -> Diagnostic {
    let written = source.snippet(value);
    if !written.starts_with(['[', '{']) || written.contains('\n') {
        return problem;
    }
    let quoted = needs_quotes::quoted(written);
    problem.suggest(needs_quotes::words(&quoted), [Edit::new(value, quoted)])
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::{check, headlines};
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            warning: [SCL0133] this `#` starts a comment, so the text ends before it
             --> topology.yaml:3:24
              |
            3 |     doc: Drives motors #1 and #2.
              |          ------------- ^ not part of the text
              |          |
              |          the text
              |
              = help: put the whole text in quotes: `doc: "Drives motors #1 and #2."`
              = help: if it is a comment, write a space after `#`"#]],
        );
    }

    #[test]
    fn a_comment_is_one() {
        for (text, is_cut) in [
            ("Drives. # twice", false),
            ("Drives. #twice", false),
            ("Drives motors #1", true),
            ("Drives (see #motors)", true),
            ("Drives (all) # of them (two)", false),
            ("'Drives' #1", false),
        ] {
            let found =
                headlines(&format!("components:\n  - name: a\n    doc: {text}\n    gates: []\nconnections: []\n"));
            assert_eq!(found.starts_with("SCL0133 "), is_cut, "{text}: {found}");
        }
    }
}
