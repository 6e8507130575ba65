//! Comments for the checker. `# scl: allow(SCL0701) reason` suppresses a warning about its line or the line below,
//! `# scl: warn(SCL0511)` turns a lint on for the whole file. SCL0901: the check is unknown. SCL0902: the comment has
//! no effect. SCL0903: the check cannot be allowed. SCL0904: no reason is given.

mod command;

use super::feedback;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::{ControlModel, Model};
use crate::source::{Line, Sources};
use command::{Command, command_span, read};
use std::collections::{HashMap, HashSet};

pub(crate) use command::{FIXED, UNKNOWN_CODE};

/// SCL0902.
pub(crate) const NO_EFFECT: Rule = Rule {
    code: "SCL0902",
    severity: Severity::Warning,
    title: "comment for the checker without effect",
    explanation: "An `allow` has nothing to allow: the problem is gone, the comment is on the wrong line, or it names \
                  another check. If the problem came back, the comment would hide it. A `warn` has no effect on a \
                  check that is on in every file. Remove or move the comment.",
    example: " components:
   - name: controller
     gates:
-      - events: pub # scl: allow(SCL0702) wired in phase 2
+      - events: pub # scl: allow(SCL0701) wired in phase 2
",
};

/// SCL0904.
pub(crate) const NO_REASON: Rule = Rule {
    code: "SCL0904",
    severity: Severity::Warning,
    title: "`allow` without a reason",
    explanation: "An `allow` gives no reason, so later readers cannot tell whether it is still needed. Write the \
                  reason after the bracket.",
    example: " components:
   - name: ui
     gates:
-      - commands: req # scl: allow(SCL0703)
+      - commands: req # scl: allow(SCL0703) the server is a program of another team
",
};

/// Applies the comments to all problems found so far, and reports what is wrong with the comments.
pub(super) fn apply(model: &Model, sources: &Sources, problems: &mut Diagnostics) {
    if model.controls.is_empty() {
        return;
    }
    let mut own = Vec::new();
    let mut requests = Requests::of(model, &mut own);
    let mut left: HashMap<Line, &'static Rule> = HashMap::new();
    problems.retain(|problem| {
        if problem.severity == Severity::Lint && requests.lints.contains(problem.rule) {
            problem.severity = Severity::Warning;
        }
        let lines = lines(problem, sources);
        let is_allowed = lines.iter().any(|line| requests.allow(problem.rule, *line));
        let line = lines.first().filter(|_| !is_allowed && problem.severity != Severity::Lint);
        line.into_iter().for_each(|line| _ = left.entry(*line).or_insert(problem.rule));
        !is_allowed
    });
    requests.report(&left, problems.has_errors(), &mut own);
    problems.extend(own);
}

/// The threshold that the file sets for a lint.
pub(super) fn threshold(model: &Model, of: &Rule) -> Option<u32> {
    let mut told_later = Vec::new();
    model.controls.iter().find_map(|control| match read(control, &mut told_later)? {
        Command::Warn { rule, threshold } if rule == of => threshold,
        _ => None,
    })
}

/// The lines for which a comment allows a check.
pub(super) fn allowed_lines(model: &Model, of: &Rule) -> HashSet<Line> {
    let mut told_later = Vec::new();
    let allows = model.controls.iter().filter(|control| match read(control, &mut told_later) {
        Some(Command::Allow { rules, .. }) => rules.contains(&of),
        _ => false,
    });
    allows.map(line_of).collect()
}

/// The line that a comment is about.
fn line_of(control: &ControlModel) -> Line {
    Line { file: control.text.span.file, number: control.line }
}

/// The requests of all comments.
struct Requests<'m> {
    /// By rule and line.
    allowed: HashMap<(&'static Rule, Line), Allow<'m>>,
    /// The lints that are turned on.
    lints: HashSet<&'static Rule>,
}

/// One code of an `allow`.
struct Allow<'m> {
    control: &'m ControlModel,
    reason: &'m str,
    used: bool,
}

impl<'m> Requests<'m> {
    fn of(model: &'m Model, own: &mut Vec<Diagnostic>) -> Self {
        let mut requests = Self { allowed: HashMap::new(), lints: HashSet::new() };
        for control in &model.controls {
            match read(control, own) {
                Some(Command::Allow { rules, reason }) => {
                    for rule in rules {
                        let place = (rule, line_of(control));
                        requests.allowed.entry(place).or_insert(Allow { control, reason, used: false });
                    }
                }
                Some(Command::Warn { rule, .. }) if rule.severity == Severity::Lint => {
                    requests.lints.insert(rule);
                }
                Some(Command::Warn { rule, .. }) => own.push(is_on(control, rule)),
                None => {}
            }
        }
        requests
    }

    /// Returns true if a comment allows the problem, and marks that comment as used.
    fn allow(&mut self, rule: &'static Rule, line: Line) -> bool {
        self.allowed.get_mut(&(rule, line)).map(|allow| allow.used = true).is_some()
    }

    /// Reports each `allow` without a reason or without effect. In a file with errors, a warning may be missing because
    /// of them, so an `allow` without effect is not reported.
    fn report(&self, left: &HashMap<Line, &'static Rule>, has_errors: bool, own: &mut Vec<Diagnostic>) {
        for (&(rule, line), allow) in &self.allowed {
            if allow.used && allow.reason.is_empty() {
                own.push(without_reason(allow.control, rule));
            } else if !allow.used && !has_errors {
                own.push(without_effect(allow.control, rule, left.get(&line).copied()));
            }
        }
    }
}

/// The lines at which a problem can be allowed: the line of its place, or, for a loop of messages, the lines of all its
/// connections.
fn lines(problem: &Diagnostic, sources: &Sources) -> Vec<Line> {
    let is_loop = [&feedback::PUSHES, &feedback::LOOP].contains(&problem.rule);
    let others = problem.secondary.iter().filter(|_| is_loop);
    let labels = problem.primary.iter().chain(others);
    labels.map(|label| sources.line(label.span)).collect()
}

fn is_on(control: &ControlModel, rule: &Rule) -> Diagnostic {
    let headline = format!("this `warn({})` has no effect", rule.code);
    NO_EFFECT.at(headline, command_span(control), "this check is on in every file").help("remove the comment")
}

fn without_reason(control: &ControlModel, rule: &Rule) -> Diagnostic {
    NO_REASON
        .at("this `allow` gives no reason", command_span(control), "")
        .help(format!("write why after it: `# scl: allow({}) server is a third-party process`", rule.code))
}

fn without_effect(control: &ControlModel, rule: &Rule, other: Option<&Rule>) -> Diagnostic {
    let Rule { code, title, .. } = rule;
    let headline = format!("this `allow({code})` has no effect");
    let label = format!("{code} is \"{title}\", which is not found here");
    let found = NO_EFFECT.at(headline, command_span(control), label);
    match other {
        Some(other) => found.help(format!("did you mean {}?", other.code)),
        None => found.help("remove the comment, or move it to the line of the problem or the line above"),
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
            found.iter().map(|found| format!("{} {}", found.code(), found.message)).collect::<Vec<_>>().join("; ")
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
            files.map(|file| problems(file, None).0.iter().map(|found| found.code()).collect::<Vec<_>>().join(" "));
        assert_eq!(codes, ["SCL0902 SCL0701", "", "SCL0902 SCL0701", "SCL0701"]);
    }

    #[test]
    fn any_connection_of_a_circle_may_allow_it() {
        let yaml = "components:\n  - name: a\n    gates:\n      - o: req\n      - i: rep\n  - name: b\n    gates:\n      - o: req\n      \
                    - i: rep\nconnections:\n  - [a.o, b.i]\n  - [b.o, a.i]";
        let codes = |end: &str| {
            problems(&format!("{yaml}{end}\n"), None).0.iter().map(|found| found.code()).collect::<Vec<_>>()
        };
        assert!(codes("").contains(&"SCL0707"));
        assert!(!codes(" # scl: allow(SCL0707) b asks only at start").contains(&"SCL0707"));
    }
}
