//! What has happened while the system was watched: components that started, became ready, ended or were killed, and the
//! first messages that a gate dropped.

use crate::live::Troubles;
use scl_observe::{Activity, Snapshot};
use serde_json::{Value, json};
use std::collections::{HashMap, HashSet, VecDeque};
use std::time::{SystemTime, UNIX_EPOCH};

/// Maximum number of events that are kept.
const KEPT: usize = 100;

/// The latest events.
#[derive(Default)]
pub(crate) struct Happenings {
    events: VecDeque<Value>,
    components: HashMap<String, (Activity, Option<u32>)>,
    dropping: HashSet<String>,
    has_begun: bool,
}

impl Happenings {
    /// Compares a snapshot with the one before.
    pub(crate) fn learn(&mut self, snapshot: &Snapshot, troubles: &Troubles) {
        let mut components = HashMap::new();
        for row in &snapshot.components {
            let before = self.components.get(&row.name).copied();
            if self.has_begun
                && let Some((kind, what)) = change(before, (row.activity, row.pid))
            {
                self.push(kind, &row.name, what);
            }
            components.insert(row.name.clone(), (row.activity, row.pid));
        }
        self.components = components;
        for gate in &snapshot.gates {
            let name = gate.name();
            if troubles.of(&name).is_some_and(|counts| counts.dropped > 0)
                && self.dropping.insert(name.clone())
                && self.has_begun
            {
                self.push("bad", &name, "has dropped its first message");
            }
        }
        self.has_begun = true;
    }

    fn push(&mut self, kind: &str, who: &str, what: &str) {
        let time = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis() as u64);
        self.events.push_back(json!({"time": time, "kind": kind, "who": who, "what": what}));
        if self.events.len() > KEPT {
            self.events.pop_front();
        }
    }

    /// The events, the earliest first.
    pub(crate) fn to_json(&self) -> Value {
        self.events.iter().cloned().collect()
    }
}

/// What has happened to a component: a class of the page, and a text.
fn change(
    before: Option<(Activity, Option<u32>)>,
    (now, pid): (Activity, Option<u32>),
) -> Option<(&'static str, &'static str)> {
    let (was, before_pid) = before.unwrap_or((Activity::Stopped, None));
    let runs = |activity: Activity| !matches!(activity, Activity::Stopped | Activity::Dead);
    match (was, now) {
        (was, Activity::Dead) if was != Activity::Dead => Some(("bad", "was killed or has crashed")),
        (was, Activity::Stopped) if was != Activity::Stopped => Some(("end", "has ended")),
        (was, now) if runs(now) && !runs(was) => Some(("start", "has started")),
        (was, now) if runs(was) && runs(now) && pid != before_pid => Some(("start", "was restarted")),
        (Activity::Hangs(_), Activity::Hangs(_)) => None,
        (_, Activity::Hangs(_)) => Some(("bad", "hangs")),
        (Activity::Hangs(_), _) => Some(("start", "works again")),
        (Activity::Waiting, Activity::Ready) => Some(("ready", "is connected with all peers")),
        (Activity::Ready, Activity::Waiting) => Some(("wait", "waits for peers")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::change;
    use scl_observe::Activity;
    use std::time::Duration;

    #[test]
    fn changes_of_a_component_are_events() {
        let hangs = |seconds| Activity::Hangs(Duration::from_secs(seconds));
        let what = |before: Option<Activity>, now: Activity| {
            change(before.map(|activity| (activity, Some(1))), (now, Some(1))).map(|(_, what)| what)
        };
        assert_eq!(what(None, Activity::Waiting), Some("has started"));
        assert_eq!(what(None, Activity::Stopped), None);
        assert_eq!(what(Some(Activity::Waiting), Activity::Ready), Some("is connected with all peers"));
        assert_eq!(what(Some(Activity::Ready), Activity::Ready), None);
        assert_eq!(what(Some(Activity::Ready), hangs(3)), Some("hangs"));
        assert_eq!(what(Some(hangs(3)), hangs(4)), None);
        assert_eq!(what(Some(hangs(4)), Activity::Dead), Some("was killed or has crashed"));
        assert_eq!(what(Some(Activity::Dead), Activity::Waiting), Some("has started"));
        assert_eq!(what(Some(Activity::Ready), Activity::Stopped), Some("has ended"));
        let restarted = change(Some((Activity::Ready, Some(1))), (Activity::Waiting, Some(2)));
        assert_eq!(restarted.map(|(_, what)| what), Some("was restarted"));
    }
}
