//! Components and gates by their names, and why one cannot be observed.

use crate::component::Component;
use crate::gate::{ObservedGate, Tap, own_tap, peer_names};
use crate::system::System;
use scl::runtime_dir::ComponentState;
use scl_plan::GatePlan;
use scl_terminal::{Problem, closest_name, escape, quoted_list};
use scl_text::gate_name;

const LIST: &str = "`scl list` shows what runs";

impl System {
    /// Finds a component by its name.
    ///
    /// # Errors
    /// There is no such component; the text suggests the closest name.
    pub fn component(&self, name: &str) -> Result<Component, Problem> {
        component(self, &self.components(), name).cloned()
    }

    /// Finds a component, or a gate and its component, by name: `component` or `component.gate`. The gate is returned
    /// as its number in the plan. The component runs or was killed; otherwise nothing is known about it.
    ///
    /// # Errors
    /// There is no such component or gate, or the component is stopped.
    pub fn component_and_gate(&self, name: &str) -> Result<(Component, Option<usize>), Problem> {
        let all = self.components();
        let (component_name, gate_name) = component_and_gate(&all, name);
        let component = component(self, &all, component_name)?;
        if component.announcement.is_none() {
            return Err(not_running(component));
        }
        let gate = gate_name.map(|gate| gate_number(&all, component, gate)).transpose()?;
        Ok((component.clone(), gate))
    }

    /// Finds a gate by its name, `component.gate`, with the taps where its messages are seen.
    ///
    /// # Errors
    /// There is no such component or gate; the component does not run; for a `sub`, `req` or `push` gate, none of its
    /// peers runs.
    pub fn gate(&self, name: &str) -> Result<ObservedGate, Problem> {
        let all = self.components();
        let (component_name, Some(gate_name)) = component_and_gate(&all, name) else {
            return Err(not_a_gate(self, &all, name));
        };
        let component = component(self, &all, component_name)?;
        if !component.is_running() {
            return Err(not_running(component));
        }
        let plan = &component.gates()[gate_number(&all, component, gate_name)?];
        let taps = taps(&all, component, plan);
        if taps.is_empty() {
            let mut hosts =
                plan.connections.iter().filter_map(|it| all.iter().find(|peer| peer.name == it.peer_component)?.host());
            return Err(match component.host().or(hosts.next()) {
                Some(host) => elsewhere(self, name, host),
                None => no_taps(name, plan),
            });
        }
        Ok(ObservedGate::new(component_name, plan, self.schema_of(component), taps))
    }
}

/// Whether the messages of a running component, or of one of its gates, are seen here now.
///
/// # Errors
/// It has no such gate, or it runs on another host and the gate's messages are seen there only.
pub(crate) fn is_seen(system: &System, all: &[Component], name: &str) -> Result<bool, Problem> {
    let (component_name, gate) = component_and_gate(all, name);
    let component = component(system, all, component_name)?;
    let number = gate.map(|gate| gate_number(all, component, gate)).transpose()?;
    let has_taps = |number: usize| !taps(all, component, &component.gates()[number]).is_empty();
    match (component.host(), number) {
        (Some(host), None) => Err(elsewhere(system, name, host)),
        (Some(host), Some(number)) if !has_taps(number) => Err(elsewhere(system, name, host)),
        (_, number) => Ok(number.is_none_or(has_taps)),
    }
}

/// A component, or a gate and its component, by a name that may be either.
fn component_and_gate<'n>(all: &[Component], name: &'n str) -> (&'n str, Option<&'n str>) {
    gate_name::component_and_gate(name, |name| all.iter().any(|component| component.name == name))
}

/// The component with this name among those of the system.
fn component<'c>(system: &System, all: &'c [Component], name: &str) -> Result<&'c Component, Problem> {
    all.iter().find(|component| component.name == name).ok_or_else(|| unknown_component(system, all, name))
}

fn gate_number(all: &[Component], component: &Component, gate: &str) -> Result<usize, Problem> {
    if component.plan().is_none() {
        return Err(without_plan(component));
    }
    let number = component.gates().iter().position(|plan| plan.name == gate);
    number.ok_or_else(|| unknown_gate(all, component, gate))
}

/// Where the messages of a running component's gate are seen: at its own tap, or at those of its running peers. A
/// component of another host has its taps there.
fn taps(all: &[Component], component: &Component, plan: &GatePlan) -> Vec<Tap> {
    match own_tap(&component.name, plan) {
        Some(_) if component.host().is_some() => Vec::new(),
        Some(tap) => vec![tap],
        None => peer_taps(all, plan).collect(),
    }
}

/// The taps of a gate's running peers on this host.
fn peer_taps(all: &[Component], plan: &GatePlan) -> impl Iterator<Item = Tap> {
    plan.connections.iter().filter_map(|connection| {
        let is_meant = |it: &&Component| it.name == connection.peer_component && it.is_running() && it.host().is_none();
        let peer = all.iter().find(is_meant)?;
        let gate = peer.gates().iter().find(|gate| gate.name == connection.peer_gate)?;
        own_tap(&peer.name, gate)
    })
}

/// The error for a component or gate whose messages are seen on another host.
fn elsewhere(system: &System, name: &str, host: &str) -> Problem {
    let (system, name, host) = (escape(system.name()), escape(name), escape(host));
    Problem::new(format!("the messages of `{name}` are seen on host `{host}`, where its component runs"))
        .help(format!("run the command there, for example `ssh {host} scl echo {name} --system {system}`"))
}

pub(crate) fn unknown_component(system: &System, all: &[Component], name: &str) -> Problem {
    let problem = Problem::new(format!("system `{}` has no component `{}`", system.name(), escape(name)));
    let names = || all.iter().map(|component| component.name.as_str());
    let problem = problem.did_you_mean_or(name, names(), |problem| problem.help(LIST));
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
        false => problem.help(format!("write one of its gates: {}", quoted_list(&gates))),
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
        false => problem.note(format!("its gates: {}", quoted_list(&names))),
    }
}

fn no_taps(name: &str, plan: &GatePlan) -> Problem {
    let peers: Vec<String> = peer_names(plan).collect();
    let problem = Problem::new(format!("`{name}` cannot be observed: none of its peers is running"));
    problem.help(LIST).note(format!(
        "messages of a `{}` gate are seen at its peers: {}",
        plan.kind.word(),
        quoted_list(&peers)
    ))
}

fn gate_names(component: &Component) -> impl Iterator<Item = String> {
    component.gates().iter().map(|gate| format!("{}.{}", component.name, gate.name))
}
