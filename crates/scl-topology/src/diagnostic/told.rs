//! Problems that are found several times and told once.

use super::{Diagnostic, Diagnostics};
use crate::source::Span;
use std::collections::HashSet;

/// The problems told so far, of a file that is read for several groups.
#[derive(Debug, Default)]
pub struct Told(HashSet<(&'static str, Span)>);

impl Told {
    /// Adds a problem, unless one of the same rule at the same place was added before.
    pub fn push(&mut self, problem: Diagnostic, problems: &mut Diagnostics) {
        let at = problem.primary.as_ref().map(|label| label.span);
        if at.is_none_or(|at| self.0.insert((problem.code(), at))) {
            problems.push(problem);
        }
    }
}
