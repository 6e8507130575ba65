//! Gates by their names, and why one cannot be observed.

use crate::component::Component;
use crate::gate::{ObservedGate, Tap, own_tap, peer_names};
use crate::system::System;
use scl::runtime_dir::ComponentState;
use scl_plan::GatePlan;
use scl_terminal::{Problem, closest_name, escape, quoted_list};

const LIST: &str = "`scl list` shows what runs";

/// The component with this name.
pub(crate) fn component<'c>(system: &System, all: &'c [Component], name: &str) -> Result<&'c Component, Problem> {
    all.iter().find(|component| component.name == name).ok_or_else(|| unknown_component(system, all, name))
}

/// The component, and the gate's number in its plan if the name has one.
pub(crate) fn component_and_gate(system: &System, name: &str) -> Result<(Component, Option<usize>), Problem> {
    let all = system.components();
    let (component_name, gate_name) = name.split_once('.').map_or((name, None), |(name, gate)| (name, Some(gate)));
    let component = component(system, &all, component_name)?;
    if component.announcement.is_none() {
        return Err(not_running(component));
    }
    let gate = gate_name.map(|gate| gate_number(&all, component, gate)).transpose()?;
    Ok((component.clone(), gate))
}

/// The gate with this name, `component.gate`.
pub(crate) fn gate(system: &System, name: &str) -> Result<ObservedGate, Problem> {
    let all = system.components();
    let Some((component_name, gate_name)) = name.split_once('.') else { return Err(not_a_gate(system, &all, name)) };
    let component = component(system, &all, component_name)?;
    if !component.is_running() {
        return Err(not_running(component));
    }
    let plan = &component.gates()[gate_number(&all, component, gate_name)?];
    let taps: Vec<Tap> = match own_tap(component_name, plan) {
        Some(tap) => vec![tap],
        None => peer_taps(&all, plan).collect(),
    };
    if taps.is_empty() {
        return Err(no_taps(name, plan));
    }
    Ok(ObservedGate::new(component_name, plan, system.schema_of(component), taps))
}

fn gate_number(all: &[Component], component: &Component, gate: &str) -> Result<usize, Problem> {
    if component.plan().is_none() {
        return Err(without_plan(component));
    }
    let number = component.gates().iter().position(|plan| plan.name == gate);
    number.ok_or_else(|| unknown_gate(all, component, gate))
}

/// The taps of a gate's running peers.
fn peer_taps(all: &[Component], plan: &GatePlan) -> impl Iterator<Item = Tap> {
    plan.connections.iter().filter_map(|connection| {
        let peer =
            all.iter().find(|component| component.name == connection.peer_component && component.is_running())?;
        let gate = peer.gates().iter().find(|gate| gate.name == connection.peer_gate)?;
        own_tap(&peer.name, gate)
    })
}

fn unknown_component(system: &System, all: &[Component], name: &str) -> Problem {
    let problem = Problem::new(format!("system `{}` has no component `{}`", system.name(), escape(name)));
    let names = || all.iter().map(|component| component.name.as_str());
    let problem = match closest_name(name, names()) {
        Some(close) => problem.help(format!("did you mean `{close}`?")),
        None => problem.help(LIST),
    };
    if all.is_empty() { problem } else { problem.note(format!("known components: {}", quoted_list(names()))) }
}

fn not_a_gate(system: &System, all: &[Component], name: &str) -> Problem {
    let Some(component) = all.iter().find(|component| component.name == name) else {
        return Problem::new(format!("`{}` is not the name of a gate", escape(name)))
            .help(format!("write `component.gate`; {LIST} with `-v`"))
            .note(format!(
                "components of `{}`: {}",
                system.name(),
                quoted_list(all.iter().map(|it| it.name.as_str()))
            ));
    };
    let problem = Problem::new(format!("`{name}` is a component, not a gate"));
    let gates: Vec<String> = gate_names(component).collect();
    match gates.is_empty() {
        true => problem.help(format!("write `{name}.gate`")),
        false => problem.help(format!("write one of its gates: {}", quoted_list(gates.iter().map(String::as_str)))),
    }
}

/// Why the gates of a component that does not run cannot be observed.
fn not_running(component: &Component) -> Problem {
    let problem = Problem::new(format!("component `{}` is not running", component.name)).help(LIST);
    match (&component.state, &component.announcement) {
        (ComponentState::Dead, Some(last)) => problem.note(format!("process {} was killed or crashed", last.pid)),
        _ => problem,
    }
}

fn without_plan(component: &Component) -> Problem {
    Problem::new(format!("component `{}` does not announce its gates", component.name))
        .help("rebuild its program with this version of SCL")
}

fn unknown_gate(all: &[Component], component: &Component, gate: &str) -> Problem {
    let problem = Problem::new(format!("component `{}` has no gate `{}`", component.name, escape(gate)));
    let own = component.gates().iter().map(|gate| gate.name.as_str());
    let elsewhere = || all.iter().filter(|other| other.gates().iter().any(|it| it.name == gate));
    let problem = match (closest_name(gate, own), elsewhere().next()) {
        (Some(close), _) => problem.help(format!("did you mean `{}.{close}`?", component.name)),
        (None, Some(other)) => problem.help(format!("did you mean `{}.{gate}`?", other.name)),
        (None, None) => problem,
    };
    let names: Vec<String> = gate_names(component).collect();
    match names.is_empty() {
        true => problem.note(format!("component `{}` has no gates", component.name)),
        false => problem.note(format!("its gates: {}", quoted_list(names.iter().map(String::as_str)))),
    }
}

fn no_taps(name: &str, plan: &GatePlan) -> Problem {
    let peers: Vec<String> = peer_names(plan).collect();
    let problem = Problem::new(format!("`{name}` cannot be observed: none of its peers is running"));
    problem.help(LIST).note(format!(
        "messages of a `{}` gate are seen at its peers: {}",
        plan.kind.word(),
        quoted_list(peers.iter().map(String::as_str))
    ))
}

fn gate_names(component: &Component) -> impl Iterator<Item = String> {
    component.gates().iter().map(|gate| format!("{}.{}", component.name, gate.name))
}
