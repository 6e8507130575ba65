//! How a connection treats messages that its peer cannot take now, as the topology declares it.

use crate::spec::{GateSpec, LinkSpec, WhenFull};

/// The queue of one connection at its sending end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Holding {
    /// How many messages may wait.
    pub(crate) capacity: usize,
    /// What happens to one more. `Wait` only where both ends agreed to it.
    pub(crate) when_full: WhenFull,
    /// Whether messages wait for a peer that is not there.
    pub(crate) for_absent: bool,
    /// Whether a peer that is not there may make the sender wait.
    pub(crate) wait_for_absent: bool,
}

impl Holding {
    /// The receiving gate's queue; it waits only where the sending gate allows that, and not for an optional component
    /// that is not running.
    pub(crate) fn of(gate: &GateSpec, link: &LinkSpec) -> Self {
        let waits = gate.backpressure || link.when_full != WhenFull::Wait;
        Self {
            capacity: link.queue as usize,
            when_full: if waits { link.when_full } else { WhenFull::DropOldest },
            for_absent: true,
            wait_for_absent: link.required,
        }
    }

    /// A tap: tools get what they can take, and nothing is kept for a tool that is not there.
    pub(crate) fn of_tap() -> Self {
        Self { capacity: 100, when_full: WhenFull::DropOldest, for_absent: false, wait_for_absent: false }
    }
}
