//! The plans of all components of a system, which together are one JSON document.

use crate::error::UnknownComponent;
use crate::plan::Plan;
use scl_text::suggest::closest_name;

/// The plans of the components of one system, or of some of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SystemPlan {
    /// The system's name.
    pub system: String,
    /// One plan per component, in the order of the topology file.
    pub components: Vec<Plan>,
    /// The kinds of components, in the order of the topology file, each with at least one of these components.
    pub kinds: Vec<KindPlan>,
}

/// Which components are of a kind: they have the same gates, and one program can be any of them.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
pub struct KindPlan {
    /// The name of the kind. No component has it.
    pub name: String,
    /// Its components, in the order of the topology file.
    pub components: Vec<String>,
}

impl SystemPlan {
    /// The plan of one component.
    ///
    /// # Errors
    /// [`UnknownComponent`] if the system has none with this name; it suggests the nearest one.
    pub fn component(&self, name: &str) -> Result<&Plan, UnknownComponent> {
        self.components.iter().find(|plan| plan.component == name).ok_or_else(|| {
            let components = self.components.iter().map(|plan| plan.component.as_str());
            let names = components.chain(self.kinds.iter().map(|kind| kind.name.as_str()));
            UnknownComponent {
                system: self.system.clone(),
                component: name.to_owned(),
                nearest: closest_name(name, names).map(str::to_owned),
                of_kind: self.kind(name).map(|kind| kind.components.clone()).unwrap_or_default(),
            }
        })
    }

    /// The kind of this name.
    pub fn kind(&self, name: &str) -> Option<&KindPlan> {
        self.kinds.iter().find(|kind| kind.name == name)
    }

    /// The part of the plan that is about a component, or about all components of a kind.
    ///
    /// # Errors
    /// Those of [`component`](Self::component).
    pub fn part(&self, name: &str) -> Result<Self, UnknownComponent> {
        let kind = self.kind(name);
        let of_kind = kind.map(|kind| kind.components.iter().map(|name| self.component(name).cloned()).collect());
        Ok(Self {
            system: self.system.clone(),
            components: of_kind.unwrap_or_else(|| self.component(name).map(|plan| vec![plan.clone()]))?,
            kinds: kind.into_iter().cloned().collect(),
        })
    }

    /// The plan of a component or, for a kind, of its first component.
    ///
    /// # Errors
    /// Those of [`component`](Self::component).
    pub fn component_or_first(&self, name: &str) -> Result<&Plan, UnknownComponent> {
        let first = self.kind(name).and_then(|kind| kind.components.first());
        self.component(first.map_or(name, String::as_str))
    }
}
