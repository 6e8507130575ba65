//! Queue policies: what the file format says about a full queue. Their words belong to the plan.

use super::Word;
use scl_plan::WhenFull;

/// All policies, in the order in which messages list them.
pub(super) static POLICIES: [Word; WhenFull::ALL.len()] = {
    let [first, second, third] = WhenFull::ALL;
    [row(first), row(second), row(third)]
};

const fn row(policy: WhenFull) -> Word {
    let word = policy.word();
    match policy {
        WhenFull::DropOldest => Word {
            word,
            summary: "drops the oldest waiting message",
            text: "The sender never waits. The receiver gets the newest messages: with `queue: 1` only the newest. \
                       Suits measurements and states. Each drop is counted in the statistics of the connection.",
        },
        WhenFull::DropNewest => Word {
            word,
            summary: "drops the message that arrives",
            text: "The sender never waits. The receiver gets the messages that arrived first. Suits the start of a \
                       recording. Each drop is counted in the statistics of the connection.",
        },
        WhenFull::Wait => Word {
            word,
            summary: "makes the sender wait",
            text: "No message is dropped. A call that sends waits until the queue has room; the sender allows that \
                       with `backpressure: true`. Suits recorders and work that must be done. Components that wait for \
                       each other in a circle can deadlock.",
        },
    }
}
