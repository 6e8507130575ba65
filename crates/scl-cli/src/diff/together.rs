//! Which components must be rebuilt together, because their programs would not connect otherwise.

use super::Side;
use super::connections::connections_of;
use super::rebuild::Rebuild;
use scl_plan::SystemPlan;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Components to rebuild. If there are several, some of them cannot connect to each other until all are rebuilt.
pub(super) type Group = Vec<Rebuild>;

/// Groups the components to rebuild: groups of several first, each in the order of the new file. `pairs` are components
/// whose old and new messages are incompatible although their connection is unchanged.
pub(super) fn group(old: &Side, new: &Side, rebuilds: Vec<Rebuild>, pairs: &[(String, String)]) -> Vec<Group> {
    let mut leaders = Leaders::default();
    if old.system != new.system {
        // Each system has its own runtime folder, so old and new programs cannot connect to each other.
        rebuilds.windows(2).for_each(|pair| leaders.join(&pair[0].component, &pair[1].component));
    }
    let present: HashSet<&str> = new.plan.components.iter().map(|plan| plan.component.as_str()).collect();
    for (one, other) in parted(&old.plan, &new.plan).into_iter().chain(pairs.iter().cloned()) {
        // A removed component does not tie its former peers together.
        if present.contains(one.as_str()) && present.contains(other.as_str()) {
            leaders.join(&one, &other);
        }
    }
    let mut groups: Vec<Group> = Vec::new();
    let mut by_leader: HashMap<String, usize> = HashMap::new();
    for rebuild in rebuilds {
        let next = groups.len();
        match *by_leader.entry(leaders.of(&rebuild.component)).or_insert(next) {
            known if known < next => groups[known].push(rebuild),
            _ => groups.push(vec![rebuild]),
        }
    }
    groups.sort_by_key(|group| group.len() == 1);
    groups
}

/// Returns the components at both ends of each connection that is new, is gone, or has another endpoint.
fn parted(old: &SystemPlan, new: &SystemPlan) -> BTreeSet<(String, String)> {
    let found = |plan| -> BTreeSet<(String, String, (String, String))> {
        connections_of(plan).map(|it| (it.name(), it.plan.endpoint.clone(), it.components())).collect()
    };
    let (old, new) = (found(old), found(new));
    old.symmetric_difference(&new).map(|(_, _, components)| components.clone()).collect()
}

/// Groups of components, each by the name of one of them.
#[derive(Default)]
struct Leaders(HashMap<String, String>);

impl Leaders {
    fn of(&self, component: &str) -> String {
        let mut found = component;
        while let Some(next) = self.0.get(found) {
            found = next;
        }
        found.to_owned()
    }

    fn join(&mut self, one: &str, other: &str) {
        let (one, other) = (self.of(one), self.of(other));
        if one != other {
            self.0.insert(other, one);
        }
    }
}
