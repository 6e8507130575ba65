//! One system's folder, opened for reading.

use crate::component::Component;
use crate::gate::{ObservedGate, own_tap};
use scl::bytes::Bytes;
use scl::runtime_dir::SystemDir;
use std::collections::BTreeSet;

/// A system, running or stopped. Each call reads anew what runs now.
#[derive(Debug, Clone)]
pub struct System {
    name: String,
    dir: SystemDir,
}

impl System {
    pub(crate) fn new(name: String, dir: SystemDir) -> Self {
        Self { name, dir }
    }

    /// Its folder.
    pub fn dir(&self) -> &SystemDir {
        &self.dir
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All components that run, were killed, or ran before, and the peers that they name, sorted by name.
    pub fn components(&self) -> Vec<Component> {
        let names = self.dir.components().unwrap_or_default();
        let mut components: Vec<Component> = names.iter().map(|name| Component::read(&self.dir, name)).collect();
        let gates = components.iter().flat_map(Component::gates);
        let peers = gates.flat_map(|gate| &gate.connections).map(|connection| connection.peer_component.clone());
        let unknown: BTreeSet<String> = peers.filter(|peer| !names.contains(peer)).collect();
        components.extend(unknown.iter().map(|name| Component::stopped(name)));
        components.sort_by(|one, other| one.name.cmp(&other.name));
        components
    }

    /// All gates of running components that have a tap of their own on this host: `pub`, `rep` and `pull`.
    pub fn gates(&self) -> Vec<ObservedGate> {
        let components = self.components();
        let here = components.iter().filter(|component| component.is_running() && component.host().is_none());
        here.flat_map(|it| self.gates_of(it)).collect()
    }

    fn gates_of(&self, component: &Component) -> Vec<ObservedGate> {
        let schema = self.schema_of(component);
        let gate = |plan| {
            Some(ObservedGate::new(&component.name, plan, schema.clone(), vec![own_tap(&component.name, plan)?]))
        };
        component.gates().iter().filter_map(gate).collect()
    }

    /// The protobuf messages that a component's program was built with.
    pub(crate) fn schema_of(&self, component: &Component) -> Option<Bytes> {
        self.dir.schema(component.announcement.as_ref()?.schema.as_deref()?)
    }
}
