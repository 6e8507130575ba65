//! The plans of all components that are known: those that run announce theirs, and the topology file or the peers tell
//! of the others.

use scl_observe::{Component, System};
use scl_plan::{Plan, SystemPlan};

/// Returns the plan of the system: what its components announce, else what the file says, else what their peers know.
pub(crate) fn plans_of(system: &System, components: &[Component], file: Option<&SystemPlan>) -> SystemPlan {
    let of_file = |name: &str| file?.components.iter().find(|plan| plan.component == name).cloned();
    let plan = |component: &Component| {
        let known = component.plan().cloned().or_else(|| of_file(&component.name));
        known.or_else(|| system.plan_of(&component.name).ok()).unwrap_or_else(|| unknown(system, &component.name))
    };
    let mut plans: Vec<Plan> = components.iter().map(plan).collect();
    let missing = file.into_iter().flat_map(|file| &file.components);
    let missing: Vec<Plan> =
        missing.filter(|plan| components.iter().all(|it| it.name != plan.component)).cloned().collect();
    plans.extend(missing);
    // As in the file, so that a component keeps its place when it starts.
    let place =
        |plan: &Plan| file.and_then(|file| file.components.iter().position(|it| it.component == plan.component));
    plans.sort_by_key(|plan| (place(plan).unwrap_or(usize::MAX), plan.component.clone()));
    SystemPlan {
        system: system.name().to_owned(),
        components: plans,
        kinds: file.map_or_else(Vec::new, |file| file.kinds.clone()),
    }
}

/// The plan of a component of which only the name is known.
fn unknown(system: &System, component: &str) -> Plan {
    Plan {
        system: system.name().to_owned(),
        component: component.to_owned(),
        declared_at: String::new(),
        schema: None,
        parameters: Vec::new(),
        gates: Vec::new(),
    }
}
