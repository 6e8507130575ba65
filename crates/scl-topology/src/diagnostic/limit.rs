//! SCL0008: limits the number of problems shown.

use super::{Diagnostic, Rule, Severity};

/// SCL0008.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0008",
    severity: Severity::Error,
    title: "too many problems",
    explanation: "The macro shows only the first 20 problems of a file, errors first, and `scl check` the first 1000. \
                  Fixing the first ones often resolves many others.",
    example: "",
};

/// Maximum number of problems of a file that the macro shows.
pub const MOST_SHOWN: usize = 20;

/// Maximum number of problems of a file that `scl check` shows.
pub const MOST_LISTED: usize = 1_000;

/// Returns at most `most` problems in the order given, with warnings left out before errors, followed by one that says
/// how many are not shown. `path` is the file as messages name it.
pub fn limit(problems: Vec<Diagnostic>, most: usize, path: &str) -> Vec<Diagnostic> {
    let total = problems.len();
    let is_first = first(problems.iter(), most);
    let (shown, hidden): (Vec<_>, Vec<_>) = problems.into_iter().zip(is_first).partition(|(_, is_first)| *is_first);
    let mut shown: Vec<Diagnostic> = shown.into_iter().map(|(problem, _)| problem).collect();
    if !hidden.is_empty() {
        let help = match (most < MOST_LISTED, total <= MOST_LISTED) {
            (true, true) => format!("run `scl check {path}` to see all of them"),
            (true, false) => format!("run `scl check {path}` to see more of them"),
            _ => "correct the first ones and check again: that often resolves many others".to_owned(),
        };
        let has_errors = hidden.iter().any(|(problem, _)| is_error(problem));
        shown.push(missing(hidden.len(), has_errors, path).help(help));
    }
    shown
}

/// Tells which problems are shown if there is room for `most` of them.
pub(crate) fn first<'p>(problems: impl Iterator<Item = &'p Diagnostic> + Clone, most: usize) -> Vec<bool> {
    let errors = problems.clone().filter(|problem| is_error(problem)).count();
    let (mut errors_left, mut others_left) = (errors.min(most), most.saturating_sub(errors));
    let is_first = |problem: &Diagnostic| {
        let left = if is_error(problem) { &mut errors_left } else { &mut others_left };
        let is_first = *left > 0;
        *left = left.saturating_sub(1);
        is_first
    };
    problems.map(is_first).collect()
}

fn is_error(problem: &Diagnostic) -> bool {
    problem.severity == Severity::Error
}

/// The problem that says how many are not shown. A warning if no error is among them, so that the file stays usable.
fn missing(count: usize, has_errors: bool, path: &str) -> Diagnostic {
    let message = match count {
        1 => format!("1 more problem in {path} is not shown"),
        _ => format!("{count} more problems in {path} are not shown"),
    };
    let mut problem = RULE.without_place(message);
    if !has_errors {
        problem.severity = Severity::Warning;
    }
    problem
}

#[cfg(test)]
mod tests {
    use super::{MOST_LISTED, MOST_SHOWN, limit};
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
            let shown = limit(problems(warnings, errors), MOST_SHOWN, "topology.yaml");
            let kept = |code| shown.iter().filter(|problem| problem.code() == code).count();
            let last = shown.last().map(|problem| (problem.severity, problem.message.clone()));
            (kept("SCL0006"), kept("SCL0001"), last.filter(|_| kept("SCL0008") > 0))
        };
        let missing = |text: &str| format!("{text} not shown");
        assert_eq!(last(3, 17), (3, 17, None));
        assert_eq!(last(4, 17), (3, 17, Some((Severity::Warning, missing("1 more problem in topology.yaml is")))));
        assert_eq!(last(5, 52), (0, 20, Some((Severity::Error, missing("37 more problems in topology.yaml are")))));
    }

    #[test]
    fn the_rest_is_where_it_can_be_seen() {
        let help = |errors, most| {
            let shown = limit(problems(0, errors), most, "topology.yaml");
            shown.last().and_then(|problem| problem.shown_helps().next().map(|help| help.text().into_owned()))
        };
        let check = |what| Some(format!("run `scl check topology.yaml` to see {what} of them"));
        assert_eq!(help(MOST_LISTED, MOST_SHOWN), check("all"));
        assert_eq!(help(MOST_LISTED + 1, MOST_SHOWN), check("more"));
        assert_eq!(help(MOST_LISTED, MOST_LISTED), None);
        let first = "correct the first ones and check again: that often resolves many others";
        assert_eq!(help(MOST_LISTED + 1, MOST_LISTED), Some(first.to_owned()));
    }
}
