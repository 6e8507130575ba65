//! Checks that the values of a plan are consistent. Those of a plan that was made from a checked topology always are.

use crate::error::PlanError;
use crate::kind::GateKind;
use crate::parameter::{ParameterPlan, ParameterType};
use crate::plan::{GatePlan, Payload, Plan};
use crate::system::SystemPlan;
use std::collections::{HashMap, HashSet};
use std::time::Duration;

/// The longest timeout of a call, and the longest time between messages: a day. Far longer ones could not be added to a
/// time.
const LONGEST: Duration = Duration::from_secs(24 * 60 * 60);

impl SystemPlan {
    /// Checks each component, that names are unique, and that the components of a kind have the same gates.
    ///
    /// # Errors
    /// [`PlanError::Inconsistent`] names the part and says what is wrong with it.
    pub fn validate(&self) -> Result<(), PlanError> {
        let mut plans = HashMap::new();
        for plan in &self.components {
            plan.validate()?;
            let is_new = plans.insert(plan.component.as_str(), plan).is_none();
            ensure(is_new, &format!("component `{}`", plan.component), "is declared twice")?;
        }
        let (mut names, mut of_kinds) = (HashSet::new(), HashSet::new());
        for kind in &self.kinds {
            let part = format!("kind `{}`", kind.name);
            ensure(names.insert(&kind.name), &part, "is declared twice")?;
            ensure(!plans.contains_key(kind.name.as_str()), &part, "has the name of a component")?;
            ensure(!kind.components.is_empty(), &part, "has no components")?;
            let mut gates = None;
            for name in &kind.components {
                ensure(of_kinds.insert(name), &part, &format!("has `{name}` twice, or together with another kind"))?;
                let Some(plan) = plans.get(name.as_str()) else {
                    return ensure(false, &part, &format!("has `{name}`, which is not among the components"));
                };
                let is_same = gates.get_or_insert_with(|| shape(plan)) == &shape(plan);
                ensure(
                    is_same,
                    &part,
                    &format!("has `{name}`, which differs from its first component in gates or parameters"),
                )?;
            }
        }
        Ok(())
    }
}

/// A gate's name, kind, payload and codec.
type GateShape<'p> = (&'p str, GateKind, &'p Payload, &'p str);

/// What the components of a kind have in common: all that a program knows of its gates, and its parameters.
fn shape(plan: &Plan) -> (Vec<GateShape<'_>>, &[ParameterPlan]) {
    let gates = plan.gates.iter().map(|gate| (gate.name.as_str(), gate.kind, &gate.payload, gate.codec.as_str()));
    (gates.collect(), &plan.parameters)
}

impl Plan {
    /// Checks that the plan contradicts neither itself nor the kinds of its gates.
    ///
    /// # Errors
    /// [`PlanError::Inconsistent`] names the part and says what is wrong with it.
    pub fn validate(&self) -> Result<(), PlanError> {
        let component = format!("component `{}`", self.component);
        ensure(!self.component.is_empty(), "a component", "has no name")?;
        ensure(!self.system.is_empty(), &component, "belongs to a system without a name")?;
        let mut names = HashSet::new();
        for parameter in &self.parameters {
            let part = format!("parameter `{}.{}`", self.component, parameter.name);
            ensure(names.insert(&parameter.name), &part, "is declared twice")?;
            validate_parameter(&part, parameter)?;
        }
        let mut names = HashSet::new();
        for gate in &self.gates {
            let part = format!("gate `{}.{}`", self.component, gate.name);
            ensure(names.insert(&gate.name), &part, "is declared twice")?;
            validate_gate(&part, gate)?;
        }
        Ok(())
    }
}

/// Checks that type, range and default agree.
fn validate_parameter(part: &str, parameter: &ParameterPlan) -> Result<(), PlanError> {
    ensure(!parameter.name.is_empty(), part, "has no name")?;
    if let ParameterType::OneOf(words) = &parameter.kind {
        let mut seen = HashSet::new();
        ensure(!words.is_empty(), part, "has no words to choose from")?;
        ensure(words.iter().all(|word| seen.insert(word)), part, "has a word twice")?;
    }
    ensure(!matches!(parameter.kind, ParameterType::List(_, Some(0))), part, "is a list of 0 items")?;
    ensure(parameter.range.is_none() || parameter.has_range(), part, "has a range, but its values have no order")?;
    ensure(parameter.range.is_none() || parameter.bounds().is_some(), part, "has a range that is none")?;
    match parameter.default_value() {
        Some(Err(reason)) => ensure(false, part, &format!("has a wrong default: {reason}")),
        _ => Ok(()),
    }
}

fn validate_gate(part: &str, gate: &GatePlan) -> Result<(), PlanError> {
    let kind = gate.kind;
    let fits = match gate.payload {
        Payload::Bytes => true,
        Payload::Message(_) => !kind.exchanges(),
        Payload::Exchange { .. } => kind.exchanges(),
    };
    ensure(!gate.name.is_empty(), part, "has no name")?;
    ensure(fits, part, &format!("is a `{}` gate, which cannot carry `{}`", kind.word(), gate.payload))?;
    ensure(
        gate.endpoint.is_some() == kind.shares_endpoint(),
        part,
        if gate.endpoint.is_some() {
            "has an endpoint, which only `rep` and `pull` gates have"
        } else {
            "has no endpoint"
        },
    )?;
    ensure(gate.tap.is_none() || kind.listens(), part, "has a tap, which only `pub`, `rep` and `pull` gates have")?;
    ensure(gate.options.queue > 0, part, "has a queue of 0 messages")?;
    ensure(gate.options.in_flight > 0, part, "allows no call to be in progress")?;
    ensure(gate.options.max_size > 0, part, "accepts messages of 0 bytes only")?;
    ensure(
        !gate.options.timeout.is_zero() && gate.options.timeout <= LONGEST,
        part,
        "has a timeout of zero or of more than a day",
    )?;
    let mut intervals = gate.options.period.iter().chain(&gate.options.deadline).chain(&gate.options.max_age);
    ensure(
        intervals.all(|interval| !interval.is_zero() && *interval <= LONGEST),
        part,
        "has a period, a deadline or a greatest age of zero or of more than a day",
    )?;
    let one_replier = kind != GateKind::Req || gate.connections.len() <= 1;
    ensure(one_replier, part, "is a `req` gate with several repliers")?;
    let mut peers = HashSet::new();
    for connection in &gate.connections {
        let peer = (&connection.peer_component, &connection.peer_gate);
        let part = format!("the connection of {part} to `{}.{}`", peer.0, peer.1);
        ensure(!peer.0.is_empty() && !peer.1.is_empty(), &part, "lacks the name of its peer")?;
        ensure(peers.insert(peer), &part, "is declared twice")?;
        ensure(!connection.endpoint.is_empty(), &part, "has no endpoint")?;
        ensure(connection.queue > 0, &part, "has a queue of 0 messages")?;
        ensure(connection.max_size > 0, &part, "accepts messages of 0 bytes only")?;
    }
    Ok(())
}

fn ensure(holds: bool, part: &str, reason: &str) -> Result<(), PlanError> {
    if holds { Ok(()) } else { Err(PlanError::Inconsistent { part: part.to_owned(), reason: reason.to_owned() }) }
}
