//! How much of a file could be read.

use crate::model::Model;

/// How much of a file could be read: problems in the rest are not known yet.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Extent {
    /// The text is not valid YAML from some place on.
    pub is_cut_off: bool,
    /// Number of parts that could not be read, because their shape is wrong.
    pub unread: usize,
}

impl Extent {
    /// The extent of a topology file.
    pub fn of(model: &Model) -> Self {
        let components = model.components.iter();
        let gates_unread = components.clone().filter(|component| component.gates_unread).count();
        let gates = components.flat_map(|component| &component.gates);
        let kindless = gates.filter(|gate| gate.kind.value.is_empty()).count();
        let sections = usize::from(model.components_unread) + usize::from(model.connections_unread);
        Self { is_cut_off: model.cut_off, unread: sections + gates_unread + kindless }
    }
}
