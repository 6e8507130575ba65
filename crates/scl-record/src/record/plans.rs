//! The plans of all components that were seen running, as one document.

use bytes::Bytes;
use scl_observe::System;
use scl_plan::{Plan, SystemPlan};
use std::collections::BTreeMap;

/// The plans by component; grows while components start.
#[derive(Debug)]
pub(crate) struct Plans {
    by_component: BTreeMap<String, Plan>,
}

impl Plans {
    /// Reads the current plans. Returns them and their text as JSON.
    pub(crate) fn of(system: &System) -> (Self, Bytes) {
        let mut plans = Self { by_component: BTreeMap::new() };
        plans.read(system);
        let text = plans.text(system);
        (plans, text)
    }

    /// Reads the plans again; returns their text if one has changed.
    pub(crate) fn update(&mut self, system: &System) -> Option<Bytes> {
        self.read(system).then(|| self.text(system))
    }

    /// The components that have parameters.
    pub(crate) fn with_parameters(&self) -> impl Iterator<Item = &str> {
        let plans = self.by_component.iter().filter(|(_, plan)| !plan.parameters.is_empty());
        plans.map(|(component, _)| component.as_str())
    }

    /// The components with gates whose messages must come in time.
    pub(crate) fn with_time(&self) -> impl Iterator<Item = &Plan> {
        let is_timed = |plan: &&Plan| {
            plan.gates.iter().any(|gate| gate.options.period.is_some() || gate.options.deadline.is_some())
        };
        self.by_component.values().filter(is_timed)
    }

    fn read(&mut self, system: &System) -> bool {
        let mut changed = false;
        for component in system.components() {
            if let Some(plan) = component.plan()
                && self.by_component.get(&component.name) != Some(plan)
            {
                self.by_component.insert(component.name.clone(), plan.clone());
                changed = true;
            }
        }
        changed
    }

    fn text(&self, system: &System) -> Bytes {
        let components = self.by_component.values().cloned().collect();
        SystemPlan { system: system.name().to_owned(), components, kinds: Vec::new() }.to_json().into()
    }
}
