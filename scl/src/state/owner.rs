//! Shared ownership of a component by its handle and its gates. The last owner closes the component on its own thread;
//! in a forked child, no owner does.

use super::ComponentState;
use crate::sync::await_other_users;
use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// A reference to a component, held by its handle and by each gate.
///
/// Tasks and other threads hold the component for a moment, too. If one of them dropped it last, it would be closed
/// there, perhaps after the program has tried to open it again, or not at all because the program has ended.
#[derive(Debug)]
pub(crate) struct Owner(Arc<ComponentState>);

impl Owner {
    /// Makes the first owner of a component.
    pub(crate) fn new(state: ComponentState) -> Self {
        state.owners.store(1, Ordering::SeqCst);
        Self(Arc::new(state))
    }
}

impl Clone for Owner {
    fn clone(&self) -> Self {
        self.owners.fetch_add(1, Ordering::SeqCst);
        Self(Arc::clone(&self.0))
    }
}

impl Deref for Owner {
    type Target = Arc<ComponentState>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        if self.is_inherited() {
            // The state belongs to the parent process. Threads that exist only there may have locked it or left it half
            // changed.
            return std::mem::forget(Arc::clone(&self.0));
        }
        if self.owners.fetch_sub(1, Ordering::SeqCst) == 1 {
            await_other_users(&self.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Unregistered;
    use crate::spec::ComponentSpec;
    use crate::state::OwnedRuntime;
    use scl_fork::ProcessMark;
    use std::thread;

    static SPEC: ComponentSpec = ComponentSpec {
        system: "nav",
        name: "gps",
        declared_at: "nav.yaml:1:2",
        parameters: &[],
        gates: &[],
        schema: None,
    };

    #[tokio::test]
    async fn the_last_owner_outlives_those_who_use_the_component_for_a_moment() {
        let owner = Owner::new(ComponentState::new(&SPEC, Box::new(Unregistered), None, None, false));
        let (another, used) = (owner.clone(), Arc::clone(&owner));
        drop(owner);
        let weak = Arc::downgrade(&used);
        let user = thread::spawn(move || {
            // The owner waits as soon as it is counted out.
            while used.owners.load(Ordering::SeqCst) > 0 {
                thread::yield_now();
            }
            drop(used);
        });
        drop(another);
        assert_eq!(weak.strong_count(), 0);
        user.join().unwrap();
    }

    /// The promise: the last owner in a forked child touches nothing of the component's runtime. The thread that waits
    /// for it exists in the parent only, and its stack, where the runtime's lists of waiting calls lead, has another
    /// use by then.
    #[test]
    fn a_forked_child_keeps_the_component_of_its_parent() {
        let runtime = OwnedRuntime::start("gps").unwrap();
        let mut state = {
            let _inside = runtime.enter();
            ComponentState::new(&SPEC, Box::new(Unregistered), None, Some(runtime), false)
        };
        state.process = ProcessMark::inherited();
        let owner = Owner::new(state);
        let kept = Arc::downgrade(&owner);
        drop(owner.clone());
        drop(owner);
        assert_eq!(kept.strong_count(), 2);
    }
}
