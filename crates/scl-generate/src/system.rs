//! What generators know of a system: plans, documentation, messages, and the places of names in the topology file.

use prost_types::FileDescriptorSet;
use scl_loader::Loaded;
use scl_plan::{GatePlan, Plan, SystemPlan};
use scl_text::list::quoted_list;
use scl_topology::source::Span;
use scl_topology::topology::{self, Topology};
use std::path::Path;

/// A system, or the components of it that were asked for.
#[derive(Debug, Clone)]
pub struct System {
    /// The system's name.
    pub name: String,
    /// The name of the topology file, without its folder: generated files must not depend on where it lies.
    pub topology_file: String,
    /// The components, in file order.
    pub components: Vec<Component>,
    /// The compiled `schemas:`, each file after the files that it imports, with comments; none without `schemas:`.
    pub descriptors: Option<FileDescriptorSet>,
    /// The folders in which these files are found by their names, relative to that of the topology file, in order.
    pub schema_folders: Vec<String>,
}

/// A component with all that its program needs.
#[derive(Debug, Clone)]
pub struct Component {
    /// The name, as in the topology file.
    pub name: String,
    /// Its name in `CamelCase`, for classes: the same in all languages, and different for all components of a system.
    pub class_name: String,
    /// Its name in `snake_case`. Unlike `class_name`, it may be the same for two components.
    pub snake_name: String,
    /// `doc:`.
    pub doc: Option<String>,
    /// Where the name is written in the topology file.
    pub span: Span,
    /// The gates, in file order.
    pub gates: Vec<Gate>,
    /// The plan, whose `gates` are those of [`Gate::plan`]. Its places name the file without its folder.
    pub plan: Plan,
    /// The other ends of its gates, for unit tests, after [`System::make_testable`]. It has no counterpart itself.
    pub counterpart: Option<Box<Component>>,
    /// The component that this one is the counterpart of.
    pub counterpart_of: Option<String>,
}

/// A gate with all that its program needs.
#[derive(Debug, Clone)]
pub struct Gate {
    /// The name, as in the topology file.
    pub name: String,
    /// Its name in `snake_case`: the same in all languages, and different for all gates of a component. It may be a
    /// keyword.
    pub snake_name: String,
    /// `doc:`.
    pub doc: Option<String>,
    /// Where the name is written in the topology file.
    pub span: Span,
    /// Kind, codec, options and connections.
    pub plan: GatePlan,
    /// The types that it carries: none, one, or a request and its reply.
    pub types: Vec<MessageUse>,
}

/// A message type that a gate carries.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MessageUse {
    /// As in the topology file: `rover.Measurement`.
    pub dotted: String,
    /// Where it is written, perhaps at the other end of a connection.
    pub span: Span,
    /// True if it is a protobuf message of `schemas:`; false if it is a Rust path.
    pub in_schemas: bool,
}

impl System {
    /// The system of a topology file; `None` if the topology has errors.
    pub fn of(loaded: &Loaded) -> Option<Self> {
        let topology = loaded.topology.as_ref()?;
        let components = topology.components().map(|(id, _)| Component::of(loaded, topology, id)).collect();
        Some(Self {
            name: topology.system().to_owned(),
            topology_file: loaded.file.map(|file| file_name(loaded.sources.file(file).path())).unwrap_or_default(),
            components,
            descriptors: loaded.schemas.as_ref().map(|schemas| schemas.file_descriptor_set.clone()),
            schema_folders: loaded.schemas.as_ref().map(|schemas| schemas.folders.clone()).unwrap_or_default(),
        })
    }

    /// Adds the counterparts of all components, for unit tests.
    pub fn make_testable(&mut self) {
        for component in &mut self.components {
            component.counterpart = Some(Box::new(component.opposite()));
        }
    }

    /// The components, each after its counterpart if it has one.
    pub fn components_and_counterparts(&self) -> impl Iterator<Item = &Component> {
        self.components.iter().flat_map(|component| component.counterpart.as_deref().into_iter().chain([component]))
    }

    /// The gates of all components and counterparts.
    pub(crate) fn gates(&self) -> impl Iterator<Item = &Gate> {
        self.components_and_counterparts().flat_map(|component| &component.gates)
    }

    /// The name in `snake_case`, for names of files, modules, namespaces and prefixes. It may be a keyword.
    pub fn snake_name(&self) -> String {
        let name = scl_topology::rust_name::gate_field(&self.name);
        if name.starts_with(|first: char| first.is_ascii_digit()) { format!("_{name}") } else { name }
    }

    /// The plan of all components, as generated files embed it: JSON without indentation, in short lines.
    pub fn plan_json(&self) -> String {
        let components = self.components.iter().map(|component| component.plan.clone()).collect();
        compact(&SystemPlan { system: self.name.clone(), components }.to_json())
    }

    /// The first line of a generated file, without the marks of a comment.
    pub fn header(&self) -> String {
        format!("Generated by `scl generate` from {}; do not edit.", self.topology_file)
    }
}

impl Component {
    fn of(loaded: &Loaded, topology: &Topology, id: topology::ComponentId) -> Self {
        let component = topology.component(id);
        let location = |span: Span| {
            let file = loaded.sources.file(span.file);
            let at = file.line_column(span.start);
            format!("{}:{}:{}", file_name(file.path()), at.line, at.column)
        };
        let plan = loaded.plan(topology, id, &location);
        let gates = component.gates().iter().zip(&plan.gates);
        Self {
            name: component.name().to_owned(),
            class_name: component.rust_name().to_owned(),
            snake_name: scl_topology::rust_name::gate_field(component.name()),
            doc: component.doc().map(str::to_owned),
            span: component.span(),
            gates: gates.map(|(&id, plan)| Gate::of(topology.gate(id), plan)).collect(),
            plan,
            counterpart: None,
            counterpart_of: None,
        }
    }

    fn opposite(&self) -> Self {
        let plan = self.plan.counterpart();
        let gates = self.gates.iter().zip(&plan.gates).map(|(gate, plan)| Gate {
            doc: Some(format!("The other end of `{}.{}`.", self.name, gate.name)),
            plan: plan.clone(),
            ..gate.clone()
        });
        Self {
            name: plan.component.clone(),
            class_name: format!("{}Peer", self.class_name),
            snake_name: format!("{}_peer", self.snake_name),
            doc: Some(format!("The other ends of all gates of `{}`, for its unit tests.", self.name)),
            span: self.span,
            gates: gates.collect(),
            plan,
            counterpart: None,
            counterpart_of: Some(self.name.clone()),
        }
    }
}

impl Gate {
    /// The gates at the other ends of its connections: `controller.sensor`.
    pub(crate) fn peers(&self) -> impl Iterator<Item = String> {
        self.plan.connections.iter().map(|it| format!("{}.{}", it.peer_component, it.peer_gate))
    }

    /// The peers as a list for a comment.
    pub(crate) fn quoted_peers(&self) -> String {
        quoted_list(self.peers())
    }

    fn of(gate: &topology::Gate, plan: &GatePlan) -> Self {
        let types = gate.payload().types().into_iter().map(|name| MessageUse {
            dotted: name.dotted().to_owned(),
            span: name.span(),
            in_schemas: name.in_schemas(),
        });
        Self {
            name: gate.name().to_owned(),
            snake_name: gate.rust_name().to_owned(),
            doc: gate.doc().map(str::to_owned),
            span: gate.span(),
            plan: plan.clone(),
            types: types.collect(),
        }
    }
}

/// The last part of a path, safe for a comment: a file name may contain line breaks.
fn file_name(path: &str) -> String {
    let name = Path::new(path).file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect()
}

/// Length at which a line of an embedded plan ends.
const PLAN_LINE: usize = 100;

/// JSON without indentation, broken into lines between its values. A line break inside a text is `\n` in JSON.
fn compact(indented: &str) -> String {
    let mut text = String::with_capacity(indented.len() / 2);
    let mut width = 0;
    for line in indented.lines().map(str::trim_start) {
        if width > 0 && width + line.len() > PLAN_LINE {
            text.push('\n');
            width = 0;
        }
        text.push_str(line);
        width += line.len();
    }
    text.push('\n');
    text
}
