//! The components of a topology as a tree of groups.

use scl_topology::topology::{ComponentId, Topology};

/// What a group contains, or, for the whole drawing, all components.
#[derive(Default)]
pub(crate) struct Frame<'t> {
    /// The components that are in no group of the frame, each with its name after those of its groups.
    pub(crate) components: Vec<(ComponentId, &'t str)>,
    /// The groups with their names, in the order of their first components.
    pub(crate) groups: Vec<(&'t str, Frame<'t>)>,
}

impl<'t> Frame<'t> {
    /// All components of a topology.
    pub(crate) fn of(topology: &'t Topology) -> Self {
        let mut all = Self::default();
        for (id, component) in topology.components() {
            let (mut frame, mut name) = (&mut all, component.name());
            while let Some((group, rest)) = name.split_once('.') {
                (frame, name) = (frame.group(group), rest);
            }
            frame.components.push((id, name));
        }
        all
    }

    /// The group of this name in the frame.
    fn group(&mut self, name: &'t str) -> &mut Self {
        let known = self.groups.iter().position(|(known, _)| *known == name);
        let at = known.unwrap_or(self.groups.len());
        if known.is_none() {
            self.groups.push((name, Self::default()));
        }
        &mut self.groups[at].1
    }
}
