//! Which components must be rebuilt: those whose plans differ.

use super::Side;
use super::connections::connection_name;
use scl_plan::{ConnectionPlan, ConstText, GatePlan, ParameterPlan, Plan};
use std::collections::HashMap;

/// A component and why it must be rebuilt.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Rebuild {
    /// Its name.
    pub(super) component: String,
    /// At least one reason.
    pub(super) reasons: Vec<String>,
}

/// The components of the new topology that must be built, in file order.
pub(super) fn find_rebuilds(old: &Side, new: &Side) -> Vec<Rebuild> {
    let before: HashMap<&str, &Plan> = old.plan.components.iter().map(|plan| (plan.component.as_str(), plan)).collect();
    let rebuild = |plan: &Plan| Rebuild {
        component: plan.component.clone(),
        reasons: match before.get(plan.component.as_str()) {
            None => vec!["it is new".to_owned()],
            Some(before) => reasons(&parts(&old.system, before), &parts(&new.system, plan)),
        },
    };
    let rebuilds = new.plan.components.iter().map(rebuild);
    rebuilds.filter(|rebuild| !rebuild.reasons.is_empty()).collect()
}

/// A part of a plan that can differ.
#[derive(PartialEq, Eq)]
enum Part<'p> {
    System(&'p str),
    Parameter(Box<ParameterPlan>),
    Gate(Box<GatePlan>),
    Connection(&'p ConnectionPlan),
}

/// The parts of a plan by name.
fn parts<'p>(system: &'p str, plan: &'p Plan) -> Vec<(String, Part<'p>)> {
    let mut parts = vec![("the system's name".to_owned(), Part::System(system))];
    for parameter in &plan.parameters {
        let alone = ParameterPlan { declared_at: ConstText::default(), ..parameter.clone() };
        parts.push((format!("parameter `{}`", parameter.name), Part::Parameter(Box::new(alone))));
    }
    for gate in &plan.gates {
        // Where a gate is declared is compiled in, too, but only for error texts.
        let alone = GatePlan { connections: Vec::new(), declared_at: String::new(), ..gate.clone() };
        parts.push((format!("gate `{}`", gate.name), Part::Gate(Box::new(alone))));
        parts.extend(gate.connections.iter().map(|connection| {
            let name = connection_name(&plan.component, gate, connection);
            (format!("connection `{name}`"), Part::Connection(connection))
        }));
    }
    parts
}

fn reasons(old: &[(String, Part<'_>)], new: &[(String, Part<'_>)]) -> Vec<String> {
    let find = |parts: &[(String, Part<'_>)], name: &str| parts.iter().any(|part| part.0 == name);
    let gone = old.iter().filter(|(name, _)| !find(new, name));
    let mut reasons: Vec<String> = gone.map(|(name, _)| format!("{name} is gone")).collect();
    for part in new {
        match find(old, &part.0) {
            false => reasons.push(format!("{} is new", part.0)),
            true if !old.contains(part) => reasons.push(format!("{} differs", part.0)),
            true => {}
        }
    }
    // If a component is connected to itself, the connection appears at two of its gates.
    reasons.dedup();
    reasons
}
