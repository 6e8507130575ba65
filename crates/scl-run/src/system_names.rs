//! The names that a launch file is checked against, and the systems that run.

use scl::runtime_dir::RuntimeDir;
use scl_plan::ParameterPlan;
use scl_topology::topology::{ComponentId, KindId, Topology};
use std::collections::HashMap;
use std::sync::Arc;

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
    /// The parameters of each component that has any, in file order. The components of a kind share them.
    pub parameters: HashMap<String, Arc<[ParameterPlan]>>,
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
            parameters: parameters(topology),
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

    /// The parameters of a component, or of the components of a kind.
    pub(crate) fn parameters_of(&self, name: &str) -> &[ParameterPlan] {
        let first_of_kind = || self.parameters.get(self.components_of(name)?.first()?);
        self.parameters.get(name).or_else(first_of_kind).map_or(&[], |parameters| parameters)
    }

    /// The parameters of a component that have neither a default nor another value.
    pub(crate) fn without_value(
        &self,
        component: &str,
        has_value: impl Fn(&str) -> bool,
    ) -> impl Iterator<Item = &ParameterPlan> {
        let parameters = self.parameters_of(component).iter();
        parameters.filter(move |parameter| parameter.default.is_none() && !has_value(&parameter.name))
    }
}

/// The parameters of each component that has any.
fn parameters(topology: &Topology) -> HashMap<String, Arc<[ParameterPlan]>> {
    let mut of_kinds: HashMap<KindId, Arc<[ParameterPlan]>> = HashMap::new();
    let components = topology.components().map(|(_, component)| component);
    let with_parameters = components.filter(|component| !component.parameters().is_empty());
    let named = with_parameters.map(|component| {
        let declared = || component.parameters().iter().map(|parameter| parameter.declared().clone()).collect();
        let parameters = match component.kind() {
            Some(kind) => Arc::clone(of_kinds.entry(kind).or_insert_with(declared)),
            None => declared(),
        };
        (component.name().to_owned(), parameters)
    });
    named.collect()
}

/// The names of the systems that run on this machine, sorted.
pub fn running_systems() -> Vec<String> {
    let runtime_dir = RuntimeDir::existing(&|name| std::env::var_os(name)).ok().flatten();
    runtime_dir.and_then(|dir| dir.running_systems().ok()).unwrap_or_default()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::SystemNames;
    use scl_plan::{ParameterPlan, ParameterType, Scalar};
    use std::sync::Arc;

    fn parameter(
        name: &'static str,
        kind: ParameterType,
        default: Option<&'static str>,
        range: Option<(&'static str, &'static str)>,
    ) -> ParameterPlan {
        ParameterPlan {
            name: name.into(),
            kind,
            default: default.map(Into::into),
            range: range.map(|(least, largest)| (least.into(), largest.into())),
            unit: None,
            doc: None,
            live: false,
            declared_at: "topology.yaml:1:1".into(),
        }
    }

    /// A system with a controller and two motors that have parameters, and a sensor without.
    pub(crate) fn rover() -> SystemNames {
        use ParameterType::{List, One, OneOf};
        let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>();
        let of_controller = [
            parameter("period", One(Scalar::Duration), Some("10ms"), None),
            parameter("gain", One(Scalar::F64), Some("0.8"), Some(("0", "10"))),
            parameter("offsets", List(Scalar::F64, Some(3)), Some("[0, 0, 0]"), Some(("-10", "10"))),
            parameter("mode", OneOf(vec!["manual".into(), "auto".into()].into()), Some("manual"), None),
            parameter("debug", One(Scalar::Bool), Some("false"), None),
            parameter("count", One(Scalar::U8), Some("1"), None),
        ];
        let of_motors =
            [parameter("pin", One(Scalar::U8), None, None), parameter("name", One(Scalar::Text), Some("motor"), None)];
        let (of_controller, of_motors): (Arc<[_]>, Arc<[_]>) = (of_controller.into(), of_motors.into());
        let parameters =
            [("controller", of_controller), ("left_motor", Arc::clone(&of_motors)), ("right_motor", of_motors)];
        SystemNames {
            system: "rover".to_owned(),
            is_named: true,
            components: words(&["sensor", "controller", "left_motor", "right_motor"]),
            kinds: vec![("motor".to_owned(), words(&["left_motor", "right_motor"]))],
            parameters: parameters.map(|(name, parameters)| (name.to_owned(), parameters)).into(),
            ..SystemNames::default()
        }
    }
}
