//! Watching a gate without borrowing it, because it may have been moved elsewhere.

use super::ready_set::ReadySet;
use crate::error::Missing;
use crate::spec::GateSpec;
use std::sync::Weak;

/// Tells which required peers of a gate are not connected, and makes the gate report when it has a message or request.
/// A dropped gate has no missing peers and reports nothing.
pub struct Watch {
    pub(crate) spec: &'static GateSpec,
    look: Box<dyn Fn() -> Vec<Missing> + Send + Sync>,
    report_to: Option<Box<dyn Fn(Weak<ReadySet>) + Send + Sync>>,
}

impl Watch {
    pub(crate) fn new(spec: &'static GateSpec, look: impl Fn() -> Vec<Missing> + Send + Sync + 'static) -> Self {
        Self { spec, look: Box::new(look), report_to: None }
    }

    /// Makes this the watch of a receiving gate, which reports to sets through `report_to`.
    pub(crate) fn reporting(self, report_to: impl Fn(Weak<ReadySet>) + Send + Sync + 'static) -> Self {
        Self { report_to: Some(Box::new(report_to)), ..self }
    }

    /// Makes the gate report to a set from now on, if it receives.
    pub(crate) fn report_to(&self, set: Weak<ReadySet>) {
        self.report_to.iter().for_each(|report_to| report_to(set.clone()));
    }

    pub(crate) fn missing(&self) -> Vec<Missing> {
        (self.look)()
    }
}
