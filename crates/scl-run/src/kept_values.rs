//! Live parameters keep their values when a component is started again: what `scl set` has set counts more than what
//! the program got at its first start.

use scl::parameters::{forget_values, values};
use scl::runtime_dir::{RuntimeDir, SystemDir};
use scl_plan::{Assignment, SET_VARIABLE, assignments, set_text};

/// The live parameters of the components that a program opens.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct KeptValues {
    /// The system of the components; `None` if it is not known, and then nothing is kept.
    pub(crate) system: Option<String>,
    /// Each component and its live parameters.
    pub(crate) live: Vec<(String, Vec<String>)>,
}

impl KeptValues {
    /// Forgets the values of an earlier run, before the first start of the program.
    pub(crate) fn forget(&self) {
        let Some(dir) = self.dir() else { return };
        self.live.iter().for_each(|(component, _)| forget_values(&dir, component));
    }

    /// The variable with which the program is started again, if any value is kept. The program would get these
    /// variables otherwise.
    pub(crate) fn variable(&self, environment: &[(String, String)]) -> Option<(String, String)> {
        let dir = self.dir()?;
        let kept = self.live.iter().flat_map(|(component, live)| {
            let kept = values(&dir, component).unwrap_or_default().into_iter().filter(|(name, _)| live.contains(name));
            kept.map(|(parameter, value)| Assignment { component: component.clone(), parameter, value })
        });
        let kept: Vec<Assignment> = kept.collect();
        if kept.is_empty() {
            return None;
        }
        let given = environment.iter().rfind(|(name, _)| name == SET_VARIABLE).map_or("", |(_, given)| given);
        // It was written by us.
        let mut all = assignments(given).unwrap_or_default();
        all.retain(|given| !kept.iter().any(|it| it.path() == given.path()));
        all.extend(kept);
        Some((SET_VARIABLE.to_owned(), set_text(&all)))
    }

    fn dir(&self) -> Option<SystemDir> {
        if self.live.is_empty() {
            return None;
        }
        let runtime_dir = RuntimeDir::existing(&|name| std::env::var_os(name)).ok()??;
        runtime_dir.existing_system(self.system.as_deref()?).ok()?
    }
}
