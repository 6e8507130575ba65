//! Watching for missing peers without borrowing the gate, which may have been moved elsewhere.

use crate::error::Missing;
use crate::spec::GateSpec;

/// Tells which required peers of a gate are not connected. A gate that was dropped misses none.
pub struct Watch {
    pub(crate) spec: &'static GateSpec,
    look: Box<dyn Fn() -> Vec<Missing> + Send + Sync>,
}

impl Watch {
    pub(crate) fn new(spec: &'static GateSpec, look: impl Fn() -> Vec<Missing> + Send + Sync + 'static) -> Self {
        Self { spec, look: Box::new(look) }
    }

    pub(crate) fn missing(&self) -> Vec<Missing> {
        (self.look)()
    }
}
