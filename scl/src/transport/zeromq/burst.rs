//! Short messages in quick succession, which are written together.

use rustix::time::{ClockId, Timespec, clock_gettime};
use std::task::Context;

/// How many messages are written one by one, each by the call that sends it, while the link is not driven. More within
/// one tick of the coarse clock (1 to 4 ms) are a burst: they are gathered until the link is driven, until there are
/// [`GATHERED`], or until something is sent after that tick.
const ONE_BY_ONE: u32 = 64;
/// How many messages of a burst are written together if the link is not driven before.
pub(super) const GATHERED: usize = 128;
/// Longer messages gain nothing from being written together.
const SHORT: usize = 4 << 10;

/// Recognizes a burst by the messages that are written one by one.
pub(super) struct Burst {
    /// Number of messages written one by one since the link was driven, and the tick in which they were written.
    one_by_one: u32,
    tick: Timespec,
}

impl Burst {
    pub(super) fn new() -> Self {
        Self { one_by_one: 0, tick: tick() }
    }

    /// Ends a burst because the link is driven: what was gathered is written in the same turn.
    pub(super) fn end(&mut self) {
        self.one_by_one = 0;
    }

    /// Expects a burst to continue, because many of its messages were just written at once: one more message is enough
    /// to confirm that.
    pub(super) fn expect_more(&mut self) {
        *self = Self { one_by_one: ONE_BY_ONE - 1, tick: tick() };
    }

    /// Returns true if a message of this length is to be gathered with others.
    pub(super) fn gathers(&self, length: usize) -> bool {
        self.one_by_one >= ONE_BY_ONE && length <= SHORT && self.tick == tick()
    }

    /// Counts a message that was written by itself. If a burst begins with it, wakes the task, which ends the burst.
    pub(super) fn count_one(&mut self, cx: &Context<'_>) {
        let now = tick();
        if std::mem::replace(&mut self.tick, now) != now {
            self.one_by_one = 0;
        }
        self.one_by_one += 1;
        if self.one_by_one == ONE_BY_ONE {
            cx.waker().wake_by_ref();
        }
    }
}

/// Returns the time of the coarse clock, which costs a fraction of an exact one and advances every 1 to 4 ms.
fn tick() -> Timespec {
    clock_gettime(ClockId::MonotonicCoarse)
}
