//! SCL0131: marks of other formats and tools that came into the file: comment signs, fences of Markdown, diffs, line
//! numbers, prompts, templates.

mod comment;
pub(in crate::parse) mod hidden;
mod in_brackets;
mod line_mark;
mod prefix;
pub(in crate::parse) mod prose;
pub(in crate::parse) mod template;

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::dialect::Dialect;
use crate::source::SourceFile;
use crate::yaml::{self, SyntaxError};
use std::ops::Range;

/// SCL0131.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0131",
    severity: Severity::Error,
    title: "mark of another format",
    explanation: "The line begins with a sign that means something in another format or tool, but not in YAML: `//`, \
                  `/*`, `--` or `;` of a comment, the fence of a Markdown code block, the `+` of a diff, the line number \
                  of a listing, the prompt of a shell, `{{` or `@NAME@` of a template, `[section]` of an INI file, a \
                  link. A comment starts with `#`, a section with its key and `:`; remove the rest.",
    example: " components:
-  // the only one
+  # the only one
   - name: sensor
     gates: []
",
};

/// Marks of one kind, found in the whole file.
struct Found {
    /// The first of them.
    at: Range<usize>,
    message: String,
    label: &'static str,
    ways: Vec<Way>,
    /// Nothing else can be meant.
    is_certain: bool,
    /// What to do if no way is left.
    otherwise: Option<&'static str>,
}

/// A help and its changes, in file order.
struct Way {
    help: String,
    changes: Vec<(Range<usize>, String)>,
}

/// The kinds, each with the function that finds its marks.
const KINDS: [fn(&str, &SourceFile) -> Option<Found>; 12] = [
    line_mark::fences,
    prefix::diff,
    prefix::line_numbers,
    comment::block,
    comment::lines,
    line_mark::half_conflict,
    line_mark::prompts,
    line_mark::editor_commands,
    line_mark::line_ends,
    line_mark::headings,
    in_brackets::indexes,
    in_brackets::links,
];

/// The problem of the first kind of marks without which the text can be read further.
pub(in crate::parse) fn find(
    error: &SyntaxError,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Diagnostic> {
    KINDS.iter().find_map(|kind| {
        let found = kind(text, source).filter(|found| found.at.start <= error.at)?;
        found.ways.iter().any(|way| reads_further(way, error, text, source, dialect)).then(|| found.diagnose(source))
    })
}

impl Found {
    fn diagnose(self, source: &SourceFile) -> Diagnostic {
        let problem = RULE.at(self.message, source.span(self.at), self.label);
        let is_certain = self.is_certain;
        let problem = self.ways.into_iter().fold(problem, |problem, way| {
            let edits = way.changes.into_iter().map(|(range, with)| Edit::new(source.span(range), with));
            if is_certain { problem.propose(way.help, edits) } else { problem.suggest(way.help, edits) }
        });
        match self.otherwise {
            Some(words) => problem.otherwise(words),
            None => problem,
        }
    }
}

/// Whether the changed text has no syntax error, or has it in a later line.
fn reads_further(way: &Way, error: &SyntaxError, text: &str, source: &SourceFile, dialect: &Dialect) -> bool {
    let mut copy = String::with_capacity(text.len());
    let mut at = 0;
    for (range, with) in &way.changes {
        copy.push_str(&text[at..range.start]);
        copy.push_str(with);
        // The lines keep their numbers.
        if with.is_empty() {
            copy.extend(text[range.clone()].chars().filter(|letter| *letter == '\n'));
        }
        at = range.end;
    }
    copy.push_str(&text[at..]);
    let tree = yaml::read(&copy, source.id(), dialect.has_aliases);
    let line_of = |at: usize| copy.as_bytes()[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
    tree.error.is_none_or(|left| line_of(left.at) > source.line(error.at) as usize)
}

/// The lines of a text with their starts, each with its line break.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut start = 0;
    text.split_inclusive('\n').map(move |line| {
        start += line.len();
        (start - line.len(), line)
    })
}

/// `line 3`, `lines 3 and 7` or `lines 3 to 7`.
pub(in crate::parse) fn line_list(starts: &[usize], source: &SourceFile) -> String {
    let numbers: Vec<u32> = starts.iter().map(|start| source.line(*start)).collect();
    match numbers.as_slice() {
        [only] => format!("line {only}"),
        [first, second] => format!("lines {first} and {second}"),
        [first, .., last] if (last - first) as usize + 1 == numbers.len() => format!("lines {first} to {last}"),
        [first, .., last] => format!("the {} such lines from {first} to {last}", numbers.len()),
        [] => "it".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::advice::apply;
    use crate::parse::testing::{check, headlines, parse_text};
    use expect_test::expect;

    const SOUND: &str = "components:\n  - name: a\n    gates: [x: {pub: , unconnected: ok}]\nconnections: []\n";

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0131] `//` starts a comment in C++ and JavaScript; in YAML, `#` does
             --> topology.yaml:2:3
              |
            2 |   // the only one
              |   ^^ starts no comment here
              |
              = help: write `# the only one`"#]],
        );
    }

    #[test]
    fn the_proposal_gives_a_sound_file() {
        let numbered = |mark: &str| -> String {
            let lines = SOUND.lines().enumerate();
            lines.map(|(at, line)| format!("{:2}{mark} {line}\n", at + 9)).collect()
        };
        for wrong in [
            format!("// first\n{SOUND}// last\n"),
            format!("; first\n{SOUND}"),
            format!("-- first\n{SOUND}"),
            format!("/* first\n * second\n */\n{SOUND}"),
            format!("<!-- first\nsecond -->\n{SOUND}"),
            SOUND.replace("[]\n", "[] // last\n"),
            SOUND.replace("[]\n", "[] /* last */\n"),
            format!("```yaml\n{SOUND}```\n"),
            format!("=======\n{SOUND}"),
            format!("$ cat a.yaml\n{SOUND}"),
            format!("me@host:~$ cat a.yaml\n{SOUND}"),
            format!("{SOUND}:wq\n"),
            SOUND.replace("[]", "[]:wq"),
            SOUND.replace("[]", "[],"),
            SOUND.replace("ok}]", "ok}];"),
            SOUND.replace("{pub: , ", "{pub: , \\\n        "),
            SOUND.replace("  - name", "+  - name"),
            SOUND.replace("  - name", "+ - name"),
            format!("@@ -1,4 +1,4 @@\n{SOUND}"),
            numbered(""),
            numbered(":"),
            numbered("|"),
            SOUND.replace("pub: ", "rep: a.B -&gt; a.C"),
        ] {
            let (_, problems, _) = parse_text(&wrong);
            assert!(problems.len() == 1 && problems[0].code() == RULE.code, "{wrong}\n{problems:?}");
            let edits: Vec<_> = problems[0].proposals().next().iter().flat_map(|way| &way.edits).collect();
            let mended = apply(&wrong, &edits).unwrap_or_default();
            assert!(!edits.is_empty() && headlines(&mended).is_empty(), "{wrong}\n{mended}");
        }
    }

    #[test]
    fn templates_are_not_read() {
        for wrong in ["{{ x }}", "{{ .x | default \"a\" }}", "<%= x %>", "{% if x %}"] {
            let found = headlines(&SOUND.replace(": a", &format!(": {wrong}")));
            assert!(found.starts_with("SCL0131 ") && found.lines().count() == 1, "{wrong}: {found}");
        }
    }

    #[test]
    fn a_file_that_is_not_fetched() {
        let found = headlines("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12\n");
        assert_eq!(found, "SCL0131 1:1 this is a pointer of Git LFS, not the file itself\n");
    }

    #[test]
    fn marks_in_texts_are_part_of_them() {
        for text in
            ["see // below", "a {{ b }}", "'{{ b }}'", "a; b -- c", "|\n      // a\n      ```\n      +b\n      $ c"]
        {
            let sound = SOUND.replace(": a\n", &format!(": a\n    doc: {text}\n"));
            assert_eq!(headlines(&sound), "", "{sound}");
        }
    }
}
