//! The plans of a loaded topology's components, with the protobuf messages that they refer to.

use crate::Loaded;
use scl_plan::{KindPlan, Plan, SystemPlan};
use scl_topology::resolve::resolve;
use scl_topology::socket_paths::SocketPaths;
use scl_topology::source::Span;
use scl_topology::topology::{ComponentId, Kind, Topology};

/// Returns the limits of socket paths on Linux: the runtime folder of the user with the largest possible id, and the
/// length of `sun_path` without its terminating NUL. The longest usual folder is assumed, so that a file that passes
/// the check works for every user.
pub(crate) fn socket_paths() -> SocketPaths {
    SocketPaths { longest_root: "/run/user/4294967295/scl".to_owned(), limit: 107 }
}

impl Loaded {
    /// The plans of all components, in file order; `None` if the topology has errors.
    pub fn system_plan(&self) -> Option<SystemPlan> {
        self.system_plan_with(&|span| self.sources.place(span))
    }

    /// [`system_plan`](Self::system_plan) with these places of declarations, for example `topology.yaml:4:11`.
    pub fn system_plan_with(&self, location: &dyn Fn(Span) -> String) -> Option<SystemPlan> {
        let topology = self.topology.as_ref()?;
        let components = topology.components().map(|(id, _)| self.plan(topology, id, location));
        Some(SystemPlan {
            system: topology.system().to_owned(),
            components: components.collect(),
            kinds: kinds(topology),
        })
    }

    /// The plan of one component of [`Loaded::topology`], with these places of declarations.
    pub fn plan(&self, topology: &Topology, component: ComponentId, location: &dyn Fn(Span) -> String) -> Plan {
        let plan = resolve(topology, component, location);
        let schema = self.schema_of(&plan);
        Plan { schema, ..plan }
    }

    /// Returns the schema of a plan's messages; `None` without `schemas:`, or if no gate carries one of its messages.
    #[cfg(feature = "protobuf")]
    fn schema_of(&self, plan: &Plan) -> Option<scl_plan::Schema> {
        let messages = plan.gates.iter().flat_map(|gate| gate.payload.types()).collect();
        self.schemas.as_ref()?.descriptors_of(&messages)
    }

    /// Returns `None`: without the feature `protobuf`, `schemas:` is an error.
    #[cfg(not(feature = "protobuf"))]
    fn schema_of(&self, _plan: &Plan) -> Option<scl_plan::Schema> {
        None
    }
}

/// The kinds that have components.
fn kinds(topology: &Topology) -> Vec<KindPlan> {
    let names = |kind: &Kind| kind.components().iter().map(|id| topology.component(*id).name().to_owned()).collect();
    let kinds = topology.kinds().filter(|(_, kind)| !kind.components().is_empty());
    kinds.map(|(_, kind)| KindPlan { name: kind.name().to_owned(), components: names(kind) }).collect()
}

#[cfg(all(test, feature = "protobuf"))]
mod tests;
