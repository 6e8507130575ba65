//! What a component does from which no messages come.

use crate::Component;
use scl::runtime_dir::ComponentState;
use std::time::SystemTime;

/// Whether a component runs, hangs or waits for peers, in some words: `not running`.
pub(crate) fn describe_state(component: Option<&Component>, now: SystemTime) -> String {
    let Some(component) = component else { return "not running".to_owned() };
    match component.state {
        ComponentState::Stopped => "not running".to_owned(),
        ComponentState::Dead => "killed or crashed".to_owned(),
        ComponentState::Running(_) => match (component.silent_for(now), &component.stats) {
            (Some(silence), _) => format!("hangs since {} s", silence.as_secs()),
            (None, Some(stats)) if !stats.ready => "not ready".to_owned(),
            _ => "running".to_owned(),
        },
    }
}
