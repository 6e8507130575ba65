//! What generators know of a system: plans, documentation, messages, and the places of names in the topology file.

mod component;
mod parameter;
mod senders;

pub use component::{Component, Gate, Instance, MessageUse};
pub use parameter::{Choice, ChoiceValue, Parameter};
pub use senders::{SenderValue, Senders};

use prost_types::FileDescriptorSet;
use scl_loader::Loaded;
use scl_plan::{Plan, SystemPlan, UnknownComponent};
use scl_topology::source::Span;
use scl_topology::topology::ComponentId;
use std::collections::HashMap;
use std::path::Path;

/// A system, or the components of it that were asked for.
#[derive(Debug, Clone)]
pub struct System {
    /// The system's name.
    pub name: String,
    /// The name of the topology file, without its folder: generated files must not depend on where it lies.
    pub topology_file: String,
    /// What becomes a type: components of no kind, and kinds, in the order of the components.
    pub components: Vec<Component>,
    /// The plans of all components, in file order. Their places name the file without its folder.
    pub plan: SystemPlan,
    /// The compiled `schemas:`, each file after the files that it imports, with comments; none without `schemas:`.
    pub descriptors: Option<FileDescriptorSet>,
    /// The folders in which these files are found by their names, relative to that of the topology file, in order.
    pub schema_folders: Vec<String>,
}

impl System {
    /// The system of a topology file; `None` if the topology has errors.
    pub fn of(loaded: &Loaded) -> Option<Self> {
        let topology = loaded.topology.as_ref()?;
        let topology_file = loaded.file.map(|file| file_name(loaded.sources.file(file).path())).unwrap_or_default();
        let location = |span: Span| loaded.place(span, &topology_file);
        let plan = loaded.system_plan_with(&location)?;
        let plans: HashMap<ComponentId, &Plan> =
            topology.components().map(|(id, _)| id).zip(&plan.components).collect();
        let components = topology.types().map(|of| Component::of(topology, of, plans[&of.id], &location)).collect();
        Some(Self {
            name: topology.system().to_owned(),
            components,
            plan,
            topology_file,
            descriptors: loaded.schemas.as_ref().map(|schemas| schemas.file_descriptor_set.clone()),
            schema_folders: loaded.schemas.as_ref().map(|schemas| schemas.folders.clone()).unwrap_or_default(),
        })
    }

    /// Keeps only these components, and for a component of a kind its whole kind.
    ///
    /// # Errors
    /// The names that neither a component nor a kind has.
    pub fn select(&mut self, names: &[String]) -> Result<(), Vec<UnknownComponent>> {
        let unknown: Vec<_> = names.iter().filter_map(|name| self.plan.component_or_first(name).err()).collect();
        if !unknown.is_empty() {
            return Err(unknown);
        }
        let is_wanted = |component: &Component| names.iter().any(|name| component.includes(name));
        let wanted = self.components.iter().filter(|component| is_wanted(component));
        // The gates of a component may tell the components of a kind apart.
        let told_apart: Vec<String> = wanted
            .flat_map(|component| &component.gates)
            .filter_map(|gate| gate.senders.as_ref()?.kind.clone())
            .collect();
        self.components.retain(|component| is_wanted(component) || told_apart.contains(&component.name));
        self.plan.components.retain(|plan| self.components.iter().any(|of| of.includes(&plan.component)));
        self.plan.kinds.retain(|kind| self.components.iter().any(|of| of.name == kind.name));
        Ok(())
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

    /// The kinds of components.
    pub(crate) fn kinds(&self) -> impl Iterator<Item = &Component> {
        self.components.iter().filter(|component| component.is_kind())
    }

    /// The component type of a kind.
    pub(crate) fn kind(&self, name: &str) -> Option<&Component> {
        self.kinds().find(|kind| kind.name == name)
    }

    /// The gates that have an enum of senders of their own, with it.
    pub(crate) fn own_senders(&self) -> impl Iterator<Item = (&Component, &Gate, &Senders)> {
        self.components.iter().flat_map(|component| component.own_senders().map(move |(of, own)| (component, of, own)))
    }

    /// The parameters of all components that are one of several words, with their enums.
    pub(crate) fn choices(&self) -> impl Iterator<Item = (&Component, &Parameter, &Choice)> {
        self.components.iter().flat_map(|component| component.choices().map(move |(of, own)| (component, of, own)))
    }

    /// The name in `snake_case`, for names of files, modules, namespaces and prefixes. It may be a keyword.
    pub fn snake_name(&self) -> String {
        let name = scl_topology::rust_name::gate_field(&self.name);
        if name.starts_with(|first: char| first.is_ascii_digit()) { format!("_{name}") } else { name }
    }

    /// The plan of all components, as generated files embed it: JSON without indentation, in short lines.
    pub fn plan_json(&self) -> String {
        compact(&self.plan.to_json())
    }

    /// The first line of a generated file, without the marks of a comment.
    pub fn header(&self) -> String {
        format!("Generated by `scl generate` from {}; do not edit.", self.topology_file)
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
