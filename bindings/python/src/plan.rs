//! The plans of a system: from their JSON text, or from a topology file that is checked when the program starts, with
//! the diagnostics of `scl check`.

use crate::failure::{Failure, no_panic};
use crate::process::detach;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use scl::host::text_with_causes;
use scl::plan::SystemPlan;
use scl::untyped::{GateError, started_as};
use scl_loader::{Request, load};
use scl_text::suggest::closest_name;
use scl_topology::diagnostic::{Severity, render};
use scl_topology::rust_name::gate_field;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The plans of the components of one system.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct Plan {
    plan: SystemPlan,
}

/// Name, name as an identifier, kind, codec, the names of its types, and its peers as `component.gate`.
type GateFacts<'p> = (&'p str, String, &'static str, &'p str, Vec<&'p str>, Vec<String>);

#[pymethods]
impl Plan {
    /// Reads plans in the format of `scl plan`.
    #[new]
    fn new(json: &str) -> PyResult<Self> {
        let plan = SystemPlan::from_json(json).map_err(|error| Failure::new("PlanError", text_with_causes(&error)))?;
        Ok(Self { plan })
    }

    /// Reads and checks a topology file. Returns the plans and the warnings; all errors together are one
    /// `TopologyError`.
    #[staticmethod]
    fn of_file(py: Python<'_>, path: PathBuf) -> PyResult<(Self, Vec<String>)> {
        let (plan, warnings) = detach(py, || no_panic(|| check(path)))??;
        Ok((Self { plan }, warnings))
    }

    #[getter]
    fn system(&self) -> &str {
        &self.plan.system
    }

    #[getter]
    fn components(&self) -> Vec<&str> {
        self.plan.components.iter().map(|plan| plan.component.as_str()).collect()
    }

    /// The name of a component or, for a kind, of the component that `SCL_COMPONENT` names.
    fn started_as(&self, name: &str) -> PyResult<&str> {
        match started_as(&self.plan, name) {
            Ok(plan) => Ok(&plan.component),
            Err(error) => Err(Failure::of(&error).into()),
        }
    }

    /// The gates of a component, in the order of the topology file.
    fn gates(&self, component: &str) -> PyResult<Vec<GateFacts<'_>>> {
        let gates = self.component(component)?.gates.iter();
        let facts = gates.map(|gate| {
            let types = gate.payload.types().collect();
            let peers = gate.connections.iter().map(|it| format!("{}.{}", it.peer_component, it.peer_gate)).collect();
            (gate.name.as_str(), gate_field(&gate.name), gate.kind.word(), gate.codec.as_str(), types, peers)
        });
        Ok(facts.collect())
    }

    /// The parameters of a component, in the order of the topology file: name and type.
    fn parameters(&self, component: &str) -> PyResult<Vec<(&str, String)>> {
        let parameters = self.component(component)?.parameters.iter();
        Ok(parameters.map(|it| (&*it.name, it.kind.to_string())).collect())
    }

    /// The plan of the other ends of a component's gates, with the messages of the component.
    fn counterpart(&self, component: &str) -> PyResult<Self> {
        let plan = self.component(component)?;
        let counterpart = scl::plan::Plan { schema: plan.schema.clone(), ..plan.counterpart() };
        Ok(Self {
            plan: SystemPlan { system: self.plan.system.clone(), components: vec![counterpart], kinds: Vec::new() },
        })
    }

    /// The messages of all components: serialized `google.protobuf.FileDescriptorSet`s.
    #[getter]
    fn schemas<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyBytes>> {
        let schemas = self.plan.components.iter().filter_map(|plan| plan.schema.as_ref());
        // The map sorts the schemas and removes duplicates.
        let schemas: BTreeMap<&str, &[u8]> = schemas.map(|it| (&*it.hash, &*it.descriptors)).collect();
        schemas.values().map(|descriptors| PyBytes::new(py, descriptors)).collect()
    }

    fn to_json(&self) -> String {
        self.plan.to_json()
    }
}

impl Plan {
    /// The plan of a component or, for a kind, of its first component.
    pub(crate) fn component(&self, name: &str) -> Result<&scl::plan::Plan, Failure> {
        self.plan.component_or_first(name).map_err(|error| Failure::new("UnknownComponent", text_with_causes(&error)))
    }
}

fn check(path: PathBuf) -> Result<(SystemPlan, Vec<String>), Failure> {
    let loaded = load(&Request::new(path));
    let texts = |severity| {
        let found = loaded.diagnostics.iter().filter(move |it| it.severity == severity);
        found.map(|it| render(it, &loaded.sources)).collect::<Vec<_>>()
    };
    match loaded.system_plan() {
        Some(plan) => Ok((plan, texts(Severity::Warning))),
        // Start on a new line: Python prints the class name first, which would shift the first line of the excerpt.
        None => Err(Failure::new("TopologyError", format!("\n{}", texts(Severity::Error).join("\n\n")))),
    }
}

/// The error text for a gate that a component does not have.
#[pyfunction]
pub(crate) fn unknown_gate(component: &str, gate: &str, known: Vec<String>) -> String {
    let nearest = closest_name(gate, known.iter().map(String::as_str)).map(str::to_owned);
    GateError::Unknown { component: component.to_owned(), gate: gate.to_owned(), nearest, known }.to_string()
}
