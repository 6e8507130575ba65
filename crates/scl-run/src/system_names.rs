//! The names that a launch file is checked against, and the systems that run.

use scl::runtime_dir::RuntimeDir;
use scl_topology::topology::{ComponentId, Topology};

/// The names in a topology file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SystemNames {
    /// The name of the system.
    pub system: String,
    /// Whether the file sets the name with `system:`. Otherwise the system is named after the file, and others may have
    /// the same name.
    pub is_named: bool,
    /// The names of its components, in file order.
    pub components: Vec<String>,
    /// Its kinds, each with its components.
    pub kinds: Vec<(String, Vec<String>)>,
    /// Its gates as `component.gate`, in file order.
    pub gates: Vec<String>,
}

impl SystemNames {
    /// The names in a topology; `is_named` says whether its file sets the name of the system.
    pub fn of(topology: &Topology, is_named: bool) -> Self {
        let name = |id: &ComponentId| topology.component(*id).name().to_owned();
        let kinds = topology.kinds().map(|(_, kind)| kind);
        let gates = topology.components().flat_map(|(_, component)| component.gates());
        Self {
            system: topology.system().to_owned(),
            is_named,
            components: topology.components().map(|(id, _)| name(&id)).collect(),
            kinds: kinds.map(|kind| (kind.name().to_owned(), kind.components().iter().map(name).collect())).collect(),
            gates: gates.map(|gate| topology.gate_path(*gate)).collect(),
        }
    }

    /// The components of a kind; `None` if there is no kind of this name.
    pub(crate) fn components_of(&self, kind: &str) -> Option<&[String]> {
        self.kinds.iter().find(|(name, _)| name == kind).map(|(_, components)| components.as_slice())
    }

    /// The kind of a component.
    pub(crate) fn kind_of(&self, component: &str) -> Option<&str> {
        let is_of = |(_, components): &&(String, Vec<String>)| components.iter().any(|name| name == component);
        self.kinds.iter().find(is_of).map(|(name, _)| name.as_str())
    }
}

/// The names of the systems that run on this machine, sorted.
pub fn running_systems() -> Vec<String> {
    let runtime_dir = RuntimeDir::existing(&|name| std::env::var_os(name)).ok().flatten();
    runtime_dir.and_then(|dir| dir.running_systems().ok()).unwrap_or_default()
}
