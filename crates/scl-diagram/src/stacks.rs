//! Which components are drawn as one block: many of a kind, in the same group.

use scl_plan::SystemPlan;
use std::collections::{HashMap, HashSet};

/// The fewest components that are drawn as one block.
const FEWEST: usize = 3;

/// The stacks of a system.
#[derive(Default)]
pub(crate) struct Stacks<'s> {
    titles: Vec<String>,
    /// The stack of each component that is in one.
    of: HashMap<&'s str, usize>,
}

impl<'s> Stacks<'s> {
    /// All components of a kind in a group, if they are many.
    pub(crate) fn of(system: &'s SystemPlan) -> Self {
        let present: HashSet<&str> = system.components.iter().map(|plan| plan.component.as_str()).collect();
        let mut stacks = Self::default();
        for kind in &system.kinds {
            let mut by_group: Vec<(&str, Vec<&str>)> = Vec::new();
            for component in kind.components.iter().map(String::as_str).filter(|name| present.contains(name)) {
                let group = component.rsplit_once('.').map_or("", |(group, _)| group);
                match by_group.iter_mut().find(|(known, _)| *known == group) {
                    Some((_, components)) => components.push(component),
                    None => by_group.push((group, vec![component])),
                }
            }
            for (_, components) in by_group.into_iter().filter(|(_, components)| components.len() >= FEWEST) {
                let name = kind.name.rsplit_once('.').map_or(&*kind.name, |(_, name)| name);
                stacks.of.extend(components.iter().map(|component| (*component, stacks.titles.len())));
                stacks.titles.push(format!("{name} ×{}", components.len()));
            }
        }
        stacks
    }

    /// The stack that a component is in.
    pub(crate) fn stack_of(&self, component: &str) -> Option<usize> {
        self.of.get(component).copied()
    }

    /// The text in the head of a stack: `wheel ×4`.
    pub(crate) fn title(&self, stack: usize) -> &str {
        &self.titles[stack]
    }

    /// The number of blocks for a system of so many components.
    pub(crate) fn blocks(&self, components: usize) -> usize {
        components - self.of.len() + self.titles.len()
    }
}
