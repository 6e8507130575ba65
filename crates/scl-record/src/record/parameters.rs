//! The values of the parameters of all components that were seen running, as one document.

use super::plans::Plans;
use bytes::Bytes;
use scl::parameters::values;
use scl_observe::System;
use serde_json::{Map, Value};

/// The values as they were last seen.
#[derive(Debug, Default)]
pub(crate) struct Parameters {
    known: Map<String, Value>,
}

impl Parameters {
    /// Reads the values again; returns them as JSON if one has changed: `{"controller": {"gain": "2"}}`.
    pub(crate) fn update(&mut self, system: &System, plans: &Plans) -> Option<Bytes> {
        let mut has_changed = false;
        for component in plans.with_parameters() {
            let Some(values) = values(system.dir(), component) else { continue };
            let values: Map<String, Value> = values.into_iter().map(|(name, value)| (name, value.into())).collect();
            let values = Value::Object(values);
            if self.known.get(component) != Some(&values) {
                self.known.insert(component.to_owned(), values);
                has_changed = true;
            }
        }
        has_changed.then(|| Value::Object(self.known.clone()).to_string().into())
    }
}
