//! SCL0008: limits the number of problems shown.

use super::{Diagnostic, Rule, Severity};

/// SCL0008.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0008",
    severity: Severity::Error,
    title: "too many problems",
    explanation: "The macro shows only the first 20 problems, errors first. `scl check` shows all of them. Fixing the \
                  first ones often resolves many others.",
    example: "",
};

/// Maximum number of problems that the macro shows.
pub const MOST_SHOWN: usize = 20;

/// Returns at most [`MOST_SHOWN`] problems in the order given, with warnings left out before errors, followed by one
/// that says how many are not shown. `path` is the file as messages name it.
pub fn limit(problems: Vec<Diagnostic>, path: &str) -> Vec<Diagnostic> {
    let total = problems.len();
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error).count();
    let (mut errors_left, mut others_left) = (errors.min(MOST_SHOWN), MOST_SHOWN.saturating_sub(errors));
    let mut shown: Vec<Diagnostic> = problems
        .into_iter()
        .filter(|problem| {
            let left = if problem.severity == Severity::Error { &mut errors_left } else { &mut others_left };
            let is_shown = *left > 0;
            *left = left.saturating_sub(1);
            is_shown
        })
        .collect();
    if total > shown.len() {
        shown.push(missing(total - shown.len(), errors > MOST_SHOWN, path));
    }
    shown
}

/// The problem that says how many are not shown. A warning if no error is among them, so that the file stays usable.
fn missing(count: usize, has_errors: bool, path: &str) -> Diagnostic {
    let message = match count {
        1 => format!("1 more problem in {path} is not shown"),
        _ => format!("{count} more problems in {path} are not shown"),
    };
    let mut problem = RULE.without_place(message).help(format!("run `scl check {path}` to see all of them"));
    if !has_errors {
        problem.severity = Severity::Warning;
    }
    problem
}

#[cfg(test)]
mod tests {
    use super::limit;
    use crate::diagnostic::{Diagnostic, Severity};
    use crate::external::{FILE_NOT_FOUND, PATH_OF_ONE_MACHINE};

    fn problems(warnings: usize, errors: usize) -> Vec<Diagnostic> {
        let mut all = vec![PATH_OF_ONE_MACHINE.without_place("w"); warnings];
        all.extend(vec![FILE_NOT_FOUND.without_place("e"); errors]);
        all
    }

    #[test]
    fn errors_are_shown_before_warnings() {
        let last = |warnings, errors| {
            let shown = limit(problems(warnings, errors), "topology.yaml");
            let kept = |code| shown.iter().filter(|problem| problem.code() == code).count();
            let last = shown.last().map(|problem| (problem.severity, problem.message.clone()));
            (kept("SCL0006"), kept("SCL0001"), last.filter(|_| kept("SCL0008") > 0))
        };
        let missing = |text: &str| format!("{text} not shown");
        assert_eq!(last(3, 17), (3, 17, None));
        assert_eq!(last(4, 17), (3, 17, Some((Severity::Warning, missing("1 more problem in topology.yaml is")))));
        assert_eq!(last(5, 52), (0, 20, Some((Severity::Error, missing("37 more problems in topology.yaml are")))));
    }
}
