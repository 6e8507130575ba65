//! What a blocking call does before it waits.

use super::calls::DIRECT_WAIT;
use super::*;
use crate::registry::Unregistered;

static SPEC: ComponentSpec = ComponentSpec {
    system: "rover",
    name: "sensor",
    declared_at: "rover.yaml:1:1",
    parameters: &[],
    gates: &[],
    schema: None,
};

/// An end that holds messages back, which its peer may take or not.
struct Holding {
    messages: usize,
    peer_takes_them: bool,
}

impl SendingEnd for Holding {
    fn poll_flushed(&mut self, _acknowledged: bool, _cx: &mut Context<'_>) -> Poll<()> {
        if self.messages == 0 { Poll::Ready(()) } else { Poll::Pending }
    }

    fn waits_for_absent_peer(&self) -> Option<Unflushed> {
        None
    }

    fn leftover(&self, _acknowledged: bool) -> Option<Unflushed> {
        None
    }

    fn drive(&mut self, _cx: &mut Context<'_>) {}

    fn write_out(&mut self) -> bool {
        if self.peer_takes_them {
            self.messages = 0;
        }
        self.messages == 0
    }

    fn detach(&mut self) {}
}

#[test]
fn a_call_writes_what_all_gates_hold_back_before_it_waits() {
    let runtime = OwnedRuntime::start("sensor").unwrap();
    let state = {
        let _inside = runtime.enter();
        ComponentState::new(&SPEC, Box::new(Unregistered), None, Some(runtime.clone()), false)
    };
    let register = |peer_takes_them| {
        let end = Arc::new(Mutex::new(Holding { messages: 3, peer_takes_them }));
        state.register(Arc::clone(&end) as _);
        end
    };
    let ends = [register(true), register(true)];
    assert_eq!(state.direct_wait(), Some(DIRECT_WAIT));
    assert!(ends.iter().all(|end| lock(end).messages == 0));
    // Its acknowledgements arrive in the runtime.
    let slow = register(false);
    assert_eq!(state.direct_wait(), None);
    lock(&slow).messages = 0;
    assert_eq!(state.direct_wait(), Some(DIRECT_WAIT));
}
