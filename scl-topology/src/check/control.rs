//! What comments say to the checker. `# scl: allow(SCL0701) reason` takes back a warning about its line or the line
//! below, `# scl: warn(SCL0511)` turns a lint on for the whole file. SCL0901: nobody knows the check. SCL0902: nothing is
//! there to allow. SCL0903: the check cannot be allowed. SCL0904: no reason is given.

use crate::catalogue;
use crate::catalogue::{Examples, Rule};
use crate::diagnostic::{Diagnostic, Diagnostics, Severity};
use crate::model::{ControlModel, Model};
use crate::source::{Sources, Span};
use crate::suggest::one_edit_away;
use std::collections::{HashMap, HashSet};

/// SCL0901.
pub(crate) const UNKNOWN_CODE: Rule = Rule {
    code: "SCL0901",
    severity: Severity::Warning,
    title: "unknown code in a comment for the checker",
    explanation: "A comment for the checker names a check that does not exist, or cannot be read at all, so it does \
                  nothing. Write `# scl: allow(CODE) reason` on the line of a problem or above it, or `# scl: \
                  warn(CODE)` to turn a lint on.",
    examples: Examples::Topology {
        bad: "# scl: allow(SCL0799)
components: []
",
        good: "components: []
",
    },
};

/// SCL0902.
pub(crate) const NO_EFFECT: Rule = Rule {
    code: "SCL0902",
    severity: Severity::Warning,
    title: "comment for the checker without effect",
    explanation: "An `allow` has nothing to allow: the problem has gone, the comment stands on another line, or it \
                  names another check. It would hide the problem when it comes back. Remove or move it.",
    examples: Examples::Topology {
        bad: "components:
  - name: controller
    gates:
      - events: pub # scl: allow(SCL0702) wired in phase 2
",
        good: "components:
  - name: controller
    gates:
      - events: pub # scl: allow(SCL0701) wired in phase 2
",
    },
};

/// SCL0903.
pub(crate) const FIXED: Rule = Rule {
    code: "SCL0903",
    severity: Severity::Error,
    title: "check that cannot be allowed",
    explanation: "The check is an error that no reason can make right: a system with it could never work. Only SCL0703 \
                  and SCL0707 are errors that somebody may know better about. Mend the cause instead.",
    examples: Examples::Topology {
        bad: "# scl: allow(SCL0601)
components: []
",
        good: "components: []
",
    },
};

/// SCL0904.
pub(crate) const NO_REASON: Rule = Rule {
    code: "SCL0904",
    severity: Severity::Warning,
    title: "`allow` without a reason",
    explanation: "Whoever reads an `allow` next year wants to know why. Write the reason after the bracket.",
    examples: Examples::Topology {
        bad: "components:
  - name: ui
    gates:
      - commands: req # scl: allow(SCL0703)
",
        good: "components:
  - name: ui
    gates:
      - commands: req # scl: allow(SCL0703) the server is a program of another team
",
    },
};

/// Errors that somebody may know better than the checker.
const ALLOWED_ERRORS: [&str; 2] = ["SCL0703", "SCL0707"];

/// A comment as understood.
enum Command<'m> {
    /// The codes, each with its place in the text, and the reason.
    Allow { codes: Vec<(&'m str, usize)>, reason: &'m str },
    /// The code with its place, and a threshold.
    Warn { code: (&'m str, usize), threshold: Option<u32> },
}

/// Applies the comments to all that was found so far, and says what is wrong with them.
pub(super) fn apply(model: &Model, sources: &Sources, problems: &mut Diagnostics) {
    if model.controls.is_empty() {
        return;
    }
    let mut own = Vec::new();
    let mut allowed: HashMap<(&str, u32), Allow<'_>> = HashMap::new();
    let mut lints = HashSet::new();
    for control in &model.controls {
        match read(control) {
            Some(Command::Allow { codes, reason }) => {
                for code in codes.into_iter().filter(|code| check_code(control, *code, &mut own)) {
                    allowed.entry((code.0, control.line)).or_insert(Allow { control, reason, used: false });
                }
            }
            Some(Command::Warn { code, .. }) => {
                if check_lint(control, code, &mut own) {
                    lints.insert(code.0);
                }
            }
            None => own.push(unreadable(control)),
        }
    }
    let mut left: HashMap<u32, &'static str> = HashMap::new();
    problems.retain(|problem| {
        if problem.severity == Severity::Lint && lints.contains(problem.code) {
            problem.severity = Severity::Warning;
        }
        let lines = lines(problem, sources);
        let is_allowed = lines.iter().any(|line| use_up(&mut allowed, problem.code, *line));
        if !is_allowed && problem.severity != Severity::Lint {
            if let Some(line) = lines.first() {
                left.entry(*line).or_insert(problem.code);
            }
        }
        !is_allowed
    });
    report(&allowed, &left, problems.has_errors(), &mut own);
    problems.extend(own);
}

/// The threshold that the file sets for a lint.
pub(super) fn threshold(model: &Model, code: &str) -> Option<u32> {
    model.controls.iter().find_map(|control| match read(control)? {
        Command::Warn { code: (of, _), threshold } if of == code => threshold,
        _ => None,
    })
}

/// One code of an `allow`.
struct Allow<'m> {
    control: &'m ControlModel,
    reason: &'m str,
    used: bool,
}

fn use_up(allowed: &mut HashMap<(&str, u32), Allow<'_>>, code: &'static str, line: u32) -> bool {
    allowed.get_mut(&(code, line)).map(|allow| allow.used = true).is_some()
}

/// The lines of a problem: that of its place; of a circle, those of all its connections.
fn lines(problem: &Diagnostic, sources: &Sources) -> Vec<u32> {
    let is_circle = matches!(problem.code, "SCL0707" | "SCL0708" | "SCL0709");
    let others = problem.secondary.iter().filter(|_| is_circle);
    let labels = problem.primary.iter().chain(others);
    labels.map(|label| sources.file(label.span.file).line_column(label.span.start).line).collect()
}

/// `scl: allow(CODE, CODE) reason`, `scl: warn(CODE)` or `scl: warn(CODE, 64)`.
fn read(control: &ControlModel) -> Option<Command<'_>> {
    let text = control.text.value.as_str();
    let (command, rest) = text.strip_prefix("scl:")?.split_once('(')?;
    let (inside, reason) = rest.split_once(')')?;
    let start = text.len() - rest.len();
    let words: Vec<(&str, usize)> = inside
        .split(',')
        .scan(start, |at, part| {
            let place = *at + part.len() - part.trim_start().len();
            *at += part.len() + 1;
            Some((part.trim(), place))
        })
        .collect();
    match (command.trim(), words.as_slice()) {
        ("allow", _) => Some(Command::Allow { codes: words, reason: reason.trim() }),
        ("warn", [code]) => Some(Command::Warn { code: *code, threshold: None }),
        ("warn", [code, (number, _)]) => Some(Command::Warn { code: *code, threshold: Some(number.parse().ok()?) }),
        _ => None,
    }
}

fn unreadable(control: &ControlModel) -> Diagnostic {
    UNKNOWN_CODE
        .at("cannot read this comment for the checker", control.text.span, "no known command")
        .help("write `# scl: allow(SCL0701) reason` to allow a warning here")
        .help("or `# scl: warn(SCL0511)` to turn a lint on for the file")
}

fn part(control: &ControlModel, (word, at): (&str, usize)) -> Span {
    let start = control.text.span.start + at as u32;
    Span { start, end: start + word.len() as u32, ..control.text.span }
}

/// `scl: allow(CODE)`, without the reason.
fn command_span(control: &ControlModel) -> Span {
    let length = control.text.value.find(')').map_or(control.text.value.len(), |at| at + 1);
    Span { end: control.text.span.start + length as u32, ..control.text.span }
}

fn is_known(control: &ControlModel, code: (&str, usize), own: &mut Vec<Diagnostic>) -> Option<Severity> {
    let rule = catalogue::find(code.0);
    if rule.is_none() {
        let similar: Vec<&str> = one_edit_away(code.0, catalogue::ALL.iter().map(|rule| rule.code));
        let found = UNKNOWN_CODE.at(format!("unknown check `{}`", code.0), part(control, code), "");
        own.push(match similar.as_slice() {
            [] => found.help("`scl explain` lists all checks"),
            [one] => found.help(format!("a check with a similar code exists: `{one}`")),
            several => found.help(format!("checks with similar codes exist: {}", super::wording::listed(several))),
        });
    }
    rule.map(|rule| rule.severity)
}

/// Whether a code can be allowed; if not, a problem says so.
fn check_code(control: &ControlModel, code: (&str, usize), own: &mut Vec<Diagnostic>) -> bool {
    let Some(severity) = is_known(control, code, own) else { return false };
    let is_fixed = severity == Severity::Error && !ALLOWED_ERRORS.contains(&code.0);
    if is_fixed {
        let title = catalogue::find(code.0).map_or("", |rule| rule.title);
        own.push(
            FIXED
                .at(format!("{} cannot be allowed", code.0), part(control, code), title)
                .help(format!("errors that can be allowed: {}", ALLOWED_ERRORS.join(", ")))
                .note("any other error means that the system could never work"),
        );
    }
    !is_fixed
}

/// Whether a code can be turned on; if not, a problem says so.
fn check_lint(control: &ControlModel, code: (&str, usize), own: &mut Vec<Diagnostic>) -> bool {
    let Some(severity) = is_known(control, code, own) else { return false };
    if severity != Severity::Lint {
        let headline = format!("this `warn({})` has no effect", code.0);
        own.push(
            NO_EFFECT.at(headline, command_span(control), "this check is on in every file").help("remove the comment"),
        );
    }
    severity == Severity::Lint
}

/// What is wrong with comments that could be read. In a file with errors a warning may be missing because of them, so
/// nothing is said of its `allow`.
fn report(
    allowed: &HashMap<(&str, u32), Allow<'_>>,
    left: &HashMap<u32, &'static str>,
    has_errors: bool,
    own: &mut Vec<Diagnostic>,
) {
    for (&(code, line), allow) in allowed {
        if allow.used && allow.reason.is_empty() {
            own.push(without_reason(allow.control, code));
        } else if !allow.used && !has_errors {
            own.push(without_effect(allow.control, code, left.get(&line).copied()));
        }
    }
}

fn without_reason(control: &ControlModel, code: &str) -> Diagnostic {
    NO_REASON
        .at("this `allow` gives no reason", command_span(control), "")
        .help(format!("write why after it: `# scl: allow({code}) server is a third-party process`"))
}

fn without_effect(control: &ControlModel, code: &str, other: Option<&'static str>) -> Diagnostic {
    let headline = format!("this `allow({code})` has no effect");
    let title = catalogue::find(code).map_or("", |rule| rule.title);
    let label = format!("{code} is \"{title}\", which is not found here");
    let found = NO_EFFECT.at(headline, command_span(control), label);
    match other {
        Some(other) => found.help(format!("did you mean {other}?")),
        None => found.help("remove the comment, or move it to the line that it is about, or above that"),
    }
}

#[cfg(test)]
mod tests {
    use super::{FIXED, NO_EFFECT, NO_REASON, UNKNOWN_CODE};
    use crate::check::testing::{problems, rule_example};
    use expect_test::expect;

    const GATE: &str = "components:\n  - name: ui\n    gates:\n      - events: pub # scl: ";

    #[test]
    fn unknown_code_in_allow() {
        rule_example(
            &UNKNOWN_CODE,
            expect![[r#"
            warning: [SCL0901] unknown check `SCL0799`
             --> topology.yaml:1:14
              |
            1 | # scl: allow(SCL0799)
              |              ^^^^^^^
              |
              = help: a check with a similar code exists: `SCL0709`
        "#]],
        );
    }

    #[test]
    fn allow_that_allows_nothing() {
        rule_example(
            &NO_EFFECT,
            expect![[r#"
            warning: [SCL0902] this `allow(SCL0702)` has no effect
             --> topology.yaml:4:23
              |
            4 |       - events: pub # scl: allow(SCL0702) wired in phase 2
              |                       ^^^^^^^^^^^^^^^^^^^ SCL0702 is "subscriber without a publisher", which is not found here
              |
              = help: did you mean SCL0701?
        "#]],
        );
    }

    #[test]
    fn check_that_cannot_be_allowed() {
        rule_example(
            &FIXED,
            expect![[r#"
            error: [SCL0903] SCL0601 cannot be allowed
             --> topology.yaml:1:14
              |
            1 | # scl: allow(SCL0601)
              |              ^^^^^^^ published and subscribed types differ
              |
              = help: errors that can be allowed: SCL0703, SCL0707
              = note: any other error means that the system could never work
        "#]],
        );
    }

    #[test]
    fn allow_without_a_reason() {
        rule_example(
            &NO_REASON,
            expect![[r#"
            warning: [SCL0904] this `allow` gives no reason
             --> topology.yaml:4:25
              |
            4 |       - commands: req # scl: allow(SCL0703)
              |                         ^^^^^^^^^^^^^^^^^^^
              |
              = help: write why after it: `# scl: allow(SCL0703) server is a third-party process`
        "#]],
        );
    }

    #[test]
    fn comments_in_many_shapes() {
        let comments = [
            "allow(SCL0701) later",
            "allow( SCL0702 ,SCL0701 ) later",
            "allow(SCL0701)",
            "alow(SCL0701) later",
            "allow SCL0701",
            "allow()",
            "warn(SCL0314)",
            "warn(SCL0701)",
            "warn(SCL0710, many)",
            "warn(SCL9999)",
            "warn(SCL0710, 3, 4)",
        ];
        let found = |comment: &str| {
            let (found, _) = problems(&format!("{GATE}{comment}\nconnections: []\n"), None);
            found.iter().map(|found| format!("{} {}", found.code, found.message)).collect::<Vec<_>>().join("; ")
        };
        let told: String = comments.iter().map(|comment| format!("{comment}: {}\n", found(comment))).collect();
        expect![[r#"
            allow(SCL0701) later: 
            allow( SCL0702 ,SCL0701 ) later: SCL0902 this `allow(SCL0702)` has no effect
            allow(SCL0701): SCL0904 this `allow` gives no reason
            alow(SCL0701) later: SCL0701 nobody subscribes to `ui.events`; SCL0901 cannot read this comment for the checker
            allow SCL0701: SCL0701 nobody subscribes to `ui.events`; SCL0901 cannot read this comment for the checker
            allow(): SCL0701 nobody subscribes to `ui.events`; SCL0901 unknown check ``
            warn(SCL0314): SCL0701 nobody subscribes to `ui.events`
            warn(SCL0701): SCL0701 nobody subscribes to `ui.events`; SCL0902 this `warn(SCL0701)` has no effect
            warn(SCL0710, many): SCL0701 nobody subscribes to `ui.events`; SCL0901 cannot read this comment for the checker
            warn(SCL9999): SCL0701 nobody subscribes to `ui.events`; SCL0901 unknown check `SCL9999`
            warn(SCL0710, 3, 4): SCL0701 nobody subscribes to `ui.events`; SCL0901 cannot read this comment for the checker
        "#]].assert_eq(&told);
    }

    #[test]
    fn the_place_of_a_comment_decides() {
        let files = [
            "# scl: allow(SCL0701) x\ncomponents:\n  - name: ui\n    gates:\n      - events: pub\nconnections: []\n",
            "components:\n  - name: ui\n    gates:\n      # scl: allow(SCL0701) x\n\n      # more\n      - events: pub\nconnections: []\n",
            "components:\n  - name: ui\n    gates: # scl: allow(SCL0701) x\n      - events: pub\nconnections: []\n",
            "components:\n  - name: ui\n    doc: '# scl: allow(SCL0701) x'\n    gates:\n      - events: pub\nconnections: []\n",
        ];
        let codes =
            files.map(|file| problems(file, None).0.iter().map(|found| found.code).collect::<Vec<_>>().join(" "));
        assert_eq!(codes, ["SCL0902 SCL0701", "", "SCL0902 SCL0701", "SCL0701"]);
    }

    #[test]
    fn any_connection_of_a_circle_may_allow_it() {
        let yaml = "components:\n  - name: a\n    gates:\n      - o: req\n      - i: rep\n  - name: b\n    gates:\n      - o: req\n      \
                    - i: rep\nconnections:\n  - [a.o, b.i]\n  - [b.o, a.i]";
        let codes =
            |end: &str| problems(&format!("{yaml}{end}\n"), None).0.iter().map(|found| found.code).collect::<Vec<_>>();
        assert!(codes("").contains(&"SCL0707"));
        assert!(!codes(" # scl: allow(SCL0707) b asks only at start").contains(&"SCL0707"));
    }
}
