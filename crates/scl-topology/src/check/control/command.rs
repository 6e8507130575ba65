//! Reads one comment for the checker. SCL0901: an unknown command or code. SCL0903: it allows an error that cannot be
//! allowed.

use crate::check::{ALL, deadlock, find, unconnected};
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::model::ControlModel;
use crate::source::Span;
use crate::suggest::one_edit_away;
use scl_text::list::listed;

/// SCL0901.
pub(crate) const UNKNOWN_CODE: Rule = Rule {
    code: "SCL0901",
    severity: Severity::Warning,
    title: "unknown code in a comment for the checker",
    explanation: "A comment for the checker names a check that does not exist, or cannot be read at all, so it does \
                  nothing. Write `# scl: allow(CODE) reason` on the line of a problem or above it, or `# scl: \
                  warn(CODE)` to turn a lint on.",
    example: "-# scl: allow(SCL0799)
 components: []
",
};

/// SCL0903.
pub(crate) const FIXED: Rule = Rule {
    code: "SCL0903",
    severity: Severity::Error,
    title: "check that cannot be allowed",
    explanation: "No reason can justify this error: a system with it could never work. Only the errors SCL0703 and \
                  SCL0707 can be allowed, where you may know more than the checker. Fix the cause instead.",
    example: "-# scl: allow(SCL0601)
 components: []
",
};

/// The errors that a comment may allow, because its author may know better than the checker.
const ALLOWED_ERRORS: [&Rule; 2] = [&unconnected::NO_REPLIER, &deadlock::RULE];

/// The number of unknown codes for which similar ones are looked up.
const MOST_SEARCHES: usize = 20;

/// A parsed comment.
pub(super) enum Command<'m> {
    /// `allow(CODE, CODE) reason`, without the codes that cannot be allowed.
    Allow { rules: Vec<&'static Rule>, reason: &'m str },
    /// `warn(CODE)`, or with a threshold `warn(CODE, 64)`.
    Warn { rule: &'static Rule, threshold: Option<u32> },
}

/// A word and its place in the text of the comment.
type Word<'m> = (&'m str, usize);

/// Parses a comment. Its mistakes are added to `own`; unknown codes and codes that cannot be allowed are left out.
pub(super) fn read<'m>(control: &'m ControlModel, own: &mut Vec<Diagnostic>) -> Option<Command<'m>> {
    let Some((command, words, reason)) = split(&control.text.value) else {
        own.push(unreadable(control));
        return None;
    };
    match (command, words.as_slice()) {
        ("allow", _) => {
            let rules = words.iter().filter_map(|word| known(control, *word, own).map(|rule| (rule, *word)));
            let rules: Vec<(&Rule, Word<'_>)> = rules.collect();
            let allowed = rules.into_iter().filter(|(rule, word)| may_be_allowed(control, rule, *word, own));
            Some(Command::Allow { rules: allowed.map(|(rule, _)| rule).collect(), reason })
        }
        ("warn", [code]) => Some(Command::Warn { rule: known(control, *code, own)?, threshold: None }),
        ("warn", [code, (number, _)]) if number.parse::<u32>().is_ok() => {
            Some(Command::Warn { rule: known(control, *code, own)?, threshold: number.parse().ok() })
        }
        _ => {
            own.push(unreadable(control));
            None
        }
    }
}

/// `scl: allow(CODE)`, without the reason.
pub(super) fn command_span(control: &ControlModel) -> Span {
    let length = control.text.value.find(')').map_or(control.text.value.len(), |at| at + 1);
    Span { end: control.text.span.start + length as u32, ..control.text.span }
}

/// Splits a comment into its command, the words in the brackets, and the text after them.
fn split(text: &str) -> Option<(&str, Vec<Word<'_>>, &str)> {
    let (command, rest) = text.strip_prefix("scl:")?.split_once('(')?;
    let (inside, reason) = rest.split_once(')')?;
    let mut at = text.len() - rest.len();
    let mut words = Vec::new();
    for part in inside.split(',') {
        words.push((part.trim(), at + part.len() - part.trim_start().len()));
        at += part.len() + 1;
    }
    Some((command.trim(), words, reason.trim()))
}

fn unreadable(control: &ControlModel) -> Diagnostic {
    UNKNOWN_CODE
        .at("cannot read this comment for the checker", control.text.span, "no known command")
        .help("write `# scl: allow(SCL0701) reason` to allow a warning here")
        .help("or `# scl: warn(SCL0511)` to turn a lint on for the file")
}

fn place(control: &ControlModel, (word, at): Word<'_>) -> Span {
    let start = control.text.span.start + at as u32;
    Span { start, end: start + word.len() as u32, ..control.text.span }
}

fn known(control: &ControlModel, word: Word<'_>, own: &mut Vec<Diagnostic>) -> Option<&'static Rule> {
    let rule = find(word.0);
    if rule.is_none() {
        let codes = ALL.iter().filter(|_| own.len() < MOST_SEARCHES).map(|rule| rule.code);
        let similar: Vec<&str> = one_edit_away(word.0, codes);
        let found = UNKNOWN_CODE.at(format!("unknown check `{}`", word.0), place(control, word), "");
        own.push(match similar.as_slice() {
            [] => found.help("codes are written as in messages: `SCL0701`"),
            [one] => found.help(format!("a check with a similar code exists: `{one}`")),
            several => found.help(format!("checks with similar codes exist: {}", listed(several))),
        });
    }
    rule
}

fn may_be_allowed(control: &ControlModel, rule: &Rule, word: Word<'_>, own: &mut Vec<Diagnostic>) -> bool {
    let is_fixed = rule.severity == Severity::Error && !ALLOWED_ERRORS.contains(&rule);
    if is_fixed {
        let found = FIXED
            .at(format!("{} cannot be allowed", rule.code), place(control, word), rule.title)
            .help(format!("errors that can be allowed: {}", ALLOWED_ERRORS.map(|rule| rule.code).join(", ")))
            .note("any other error means that the system could never work");
        own.push(found);
    }
    !is_fixed
}
