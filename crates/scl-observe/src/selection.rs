//! Gates that the user selects by name, including gates of components that do not run yet.

use crate::gate::ObservedGate;
use crate::lookup;
use crate::system::System;
use scl_loader::{Request, load};
use scl_plan::SystemPlan;
use scl_terminal::{Problem, closest_name, escape, quoted_list};
use scl_text::gate_name::{component_and_gate, split};
use std::path::Path;

/// Gates and whole components, named by the user.
///
/// A component stands for its `pub`, `rep` and `pull` gates, where messages are seen. A `sub`, `req` or `push` gate
/// stands for the gates of its peers where its messages are seen.
#[derive(Debug, Clone)]
pub struct Selection {
    /// Empty: all.
    wanted: Vec<Name>,
    excluded: Vec<Name>,
    waiting: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Name {
    component: String,
    /// `None`: all gates of the component.
    gate: Option<String>,
}

impl Selection {
    /// Looks up the names among the running components and, for components that do not run, in the topology file if
    /// that describes this system. Without such a file, a component that nothing is known about is assumed to start
    /// later.
    ///
    /// # Errors
    /// A name is unknown, or its component runs on another host.
    pub fn new(system: &System, wanted: &[String], excluded: &[String], topology: &Path) -> Result<Self, Problem> {
        let mut lookup = Lookup { system, topology, planned: None, waiting: Vec::new() };
        let wanted = wanted.iter().map(|name| lookup.name(name)).collect::<Result<Vec<_>, _>>()?;
        let waiting = std::mem::take(&mut lookup.waiting);
        let excluded = excluded.iter().map(|name| lookup.name(name)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { wanted, excluded, waiting })
    }

    /// The wanted names whose components, or all peers where their messages are seen, do not run.
    pub fn waiting(&self) -> &[String] {
        &self.waiting
    }

    /// Whether exactly one gate is wanted.
    pub fn is_one_gate(&self) -> bool {
        matches!(&self.wanted[..], [Name { gate: Some(_), .. }])
    }

    /// Whether the messages seen at this gate are wanted.
    pub fn includes(&self, gate: &ObservedGate) -> bool {
        let is_named = |names: &[Name]| names.iter().any(|name| name.means(gate));
        (self.wanted.is_empty() || is_named(&self.wanted)) && !is_named(&self.excluded)
    }

    /// Whether each wanted name stands for at least one of these gates.
    pub fn is_complete(&self, gates: &[ObservedGate]) -> bool {
        self.wanted.iter().all(|name| gates.iter().any(|gate| name.means(gate)))
    }
}

impl Name {
    fn means(&self, gate: &ObservedGate) -> bool {
        match &self.gate {
            None => self.component == gate.component,
            Some(name) => {
                self.component == gate.component && *name == gate.gate
                    || gate.peers.iter().any(|peer| split(peer) == Some((&self.component, name)))
            }
        }
    }
}

struct Lookup<'s> {
    system: &'s System,
    topology: &'s Path,
    /// The plan of the topology file, once it was read; `Some(None)` if the file does not describe this system.
    planned: Option<Option<SystemPlan>>,
    waiting: Vec<String>,
}

impl Lookup<'_> {
    fn name(&mut self, written: &str) -> Result<Name, Problem> {
        let all = self.system.components();
        let is_running = |name: &str| all.iter().any(|it| it.name == name);
        let is_planned = self.planned().map(|plan| |name: &str| plan.component(name).is_ok());
        let is_component =
            |name: &str| is_running(name) || is_planned.as_ref().is_some_and(|is_planned| is_planned(name));
        let (component, gate) = component_and_gate(written, is_component);
        let name = Name { component: component.to_owned(), gate: gate.map(str::to_owned) };
        let known = all.iter().find(|it| it.name == component);
        if known.is_some_and(|known| known.is_running()) {
            if !lookup::is_seen(self.system, &all, written)? {
                self.waiting.push(written.to_owned());
            }
            return Ok(name);
        }
        let planned = self.planned().is_some();
        if planned {
            self.check_planned(component, gate)?;
        } else if known.is_none() && closest_name(component, all.iter().map(|it| it.name.as_str())).is_some() {
            return Err(lookup::unknown_component(self.system, &all, component));
        }
        self.waiting.push(written.to_owned());
        Ok(name)
    }

    fn planned(&mut self) -> Option<&SystemPlan> {
        let (system, topology) = (self.system, self.topology);
        let read = || {
            let plan = topology.is_file().then(|| load(&Request::new(topology)))?.system_plan()?;
            (plan.system == system.name()).then_some(plan)
        };
        self.planned.get_or_insert_with(read).as_ref()
    }

    fn check_planned(&mut self, component: &str, gate: Option<&str>) -> Result<(), Problem> {
        let file = self.topology.display().to_string();
        let Some(plan) = self.planned() else { return Ok(()) };
        let unknown = |text: String, wrong: &str, names: Vec<&str>| {
            let problem = Problem::new(text);
            let problem = problem.did_you_mean(wrong, names.iter().copied());
            Err(problem.note(format!("known in `{file}`: {}", quoted_list(names))))
        };
        let Ok(planned) = plan.component(component) else {
            let names = plan.components.iter().map(|it| it.component.as_str()).collect();
            let text = format!("system `{}` has no component `{}`", plan.system, escape(component));
            return unknown(text, component, names);
        };
        match gate {
            Some(gate) if planned.gate(gate).is_none() => {
                let names = planned.gates.iter().map(|it| it.name.as_str()).collect();
                unknown(format!("component `{component}` has no gate `{}`", escape(gate)), gate, names)
            }
            _ => Ok(()),
        }
    }
}
