//! What a component does from which no messages come.

use crate::Component;
use crate::activity::Activity;
use std::time::SystemTime;

/// Whether a component runs, hangs or waits for peers, in some words: `not running`.
pub(crate) fn describe_state(component: Option<&Component>, now: SystemTime) -> String {
    match component.map_or(Activity::Stopped, |component| component.activity(now)) {
        Activity::Hangs(silence) => format!("hangs since {} s", silence.as_secs()),
        Activity::Stopped => "not running".to_owned(),
        Activity::Dead => "killed or crashed".to_owned(),
        Activity::Running | Activity::Ready => "running".to_owned(),
        Activity::Waiting => "waiting for its peers".to_owned(),
    }
}
