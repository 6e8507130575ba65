//! The last lines of a run: which components failed and why, and which were restarted.

use super::lifecycle::{Lifecycle, State, Verdict};
use super::member::{Member, Role};
use super::run_state::RunState;

/// A line for each component that failed or was restarted.
pub(crate) fn lines(members: &[Member<'_>], state: &RunState) -> Vec<String> {
    let components = members.iter().zip(state.components());
    components.filter_map(|(member, component)| line(member, component)).collect()
}

fn line(member: &Member<'_>, component: &Lifecycle) -> Option<String> {
    let failure = component.failure.as_deref().unwrap_or("ended");
    let restarts = match component.restarts.total {
        0 => String::new(),
        1 => "restarted once".to_owned(),
        2 => "restarted twice".to_owned(),
        more => format!("restarted {more} times"),
    };
    let has_failed = component.state == State::Ended(Verdict::Failed);
    let name = member.name;
    let kind = match (member.role, component.policy.essential) {
        (Role::Gateway | Role::Recorder, _) => "program",
        (_, true) => "component",
        (_, false) => "non-essential component",
    };
    match (has_failed, restarts.as_str()) {
        (true, "") => Some(format!("{kind} `{name}` failed: {failure}")),
        (true, _) => Some(format!("{kind} `{name}` failed: {failure}; it was {restarts}")),
        (false, "") => None,
        (false, _) => Some(format!("{kind} `{name}` was {restarts}; last reason: {failure}")),
    }
}
