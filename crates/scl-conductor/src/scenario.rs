//! Scenarios: what goes wrong in a simulation, and what must hold all the same.

mod conditions;
mod dialect;
mod reader;
mod rules;
#[cfg(test)]
mod tests;

use crate::faults::{Fault, FaultRule, When, faults};
use crate::random::Between;
use crate::routes::Route;
pub use conditions::{Expectation, Expected, Failure, unmet};
use scl_plan::SystemPlan;
use scl_terminal::Problem;
use scl_topology::diagnostic::{Diagnostics, render};
use scl_topology::parse::read_document;
use scl_topology::source::Sources;
use std::time::Duration;

/// What a scenario file says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scenario {
    /// When the simulation ends at the latest.
    pub until: Option<Duration>,
    /// For components: how long after something that it waits for has happened it goes on.
    pub takes: Vec<(String, Between)>,
    /// What goes wrong.
    pub(crate) faults: Vec<FaultRule>,
    /// The connections that do not always carry everything at once.
    pub(crate) routes: Vec<Route>,
    /// What must hold.
    pub expectations: Vec<Expectation>,
}

impl Scenario {
    /// Reads a scenario for a system; `path` is how messages name the file.
    ///
    /// # Errors
    /// Every mistake in the text, in its order.
    pub fn read(path: &str, text: &str, system: &SystemPlan) -> Result<Self, Vec<Problem>> {
        let mut sources = Sources::new();
        let file = sources.add(path, text);
        let mut problems = Diagnostics::new();
        let document = read_document(sources.file(file), &dialect::SCENARIO, &mut problems);
        let of_text = problems.into_sorted();
        if !of_text.is_empty() {
            return Err(of_text.iter().map(|problem| Problem::rendered(render(problem, &sources))).collect());
        }
        let mut reader = reader::Reader::new(sources.file(file), system);
        let scenario = document.root.as_ref().map(|root| reader.scenario(root)).unwrap_or_default();
        if reader.problems.is_empty() { Ok(scenario) } else { Err(reader.problems) }
    }

    /// Returns what goes wrong in a simulation with this seed, up to its end.
    ///
    /// # Errors
    /// Something goes wrong again and again, and the simulation has no end.
    pub fn faults(&self, seed: u64, until: Option<Duration>) -> Result<Vec<Fault>, Problem> {
        if until.is_none() && self.faults.iter().any(|rule| matches!(rule.when, When::Every { .. })) {
            let problem = Problem::new("faults come again and again, but the simulation has no end");
            return Err(problem.help("write `until: 2min` in the scenario, or give `--until`"));
        }
        Ok(faults(&self.faults, seed, until.unwrap_or(Duration::MAX)))
    }
}
