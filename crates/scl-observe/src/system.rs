//! One system's folder, opened for reading.

use crate::component::Component;
use crate::find::{find_or_create_system, find_system, find_systems};
use crate::gate::{ObservedGate, own_tap};
use scl::bytes::Bytes;
use scl::runtime_dir::SystemDir;
use scl_terminal::Problem;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::Path;

/// A system, running or stopped. Each call reads anew what runs now.
#[derive(Debug, Clone)]
pub struct System {
    name: String,
    dir: SystemDir,
}

impl System {
    /// Finds a system: the one with this name, else `$SCL_SYSTEM`, else the only one that runs, else that of
    /// `topology.yaml` in the working folder.
    ///
    /// # Errors
    /// The system does not exist, none or several run, or the runtime folder cannot be used. The text lists the running
    /// systems.
    pub fn find(name: Option<&str>) -> Result<Self, Problem> {
        Self::find_with(name, &|variable| std::env::var_os(variable), Path::new("."))
    }

    /// [`find`](Self::find) with another environment and working folder.
    ///
    /// # Errors
    /// Those of `find`.
    pub fn find_with(
        name: Option<&str>,
        variables: &dyn Fn(&str) -> Option<OsString>,
        folder: &Path,
    ) -> Result<Self, Problem> {
        find_system(name, variables, folder).map(|(name, dir)| Self { name, dir })
    }

    /// [`find`](Self::find), but a named system need not have run here: its components are noticed when they start.
    ///
    /// # Errors
    /// The name is probably misspelled, because a system with a similar name exists; otherwise those of `find`.
    pub fn find_or_await(name: Option<&str>) -> Result<Self, Problem> {
        let variables = |variable: &str| std::env::var_os(variable);
        let (name, dir) = find_or_create_system(name, &variables, Path::new("."))?;
        Ok(Self { name, dir })
    }

    /// The systems of which a query without a name shows all: the one with this name, else `$SCL_SYSTEM`, else all that
    /// run, else what [`find`](Self::find) finds.
    ///
    /// # Errors
    /// Those of `find`, but for several that run.
    pub fn find_all(name: Option<&str>) -> Result<Vec<Self>, Problem> {
        let variables = |variable: &str| std::env::var_os(variable);
        let found = find_systems(name, &variables, Path::new("."))?;
        Ok(found.into_iter().map(|(name, dir)| Self { name, dir }).collect())
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
