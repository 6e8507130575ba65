//! A stream of messages from one gateway to another: in order, each at most once, with credit, over a network library
//! that drops messages silently.
//!
//! The sending end keeps a message until the receiving component has taken it, and never keeps more messages than the
//! window. Losses show as a gap in the numbers, or in the answer to a probe, which is sent behind the messages; then
//! the sending end starts over after the last message that has arrived. `outgoing` and `incoming` make the decisions,
//! without I/O; the ends carry them out.

mod incoming;
mod outgoing;
mod receiving_end;
mod sending_end;

pub use self::receiving_end::ReceiverEvent;
pub(super) use self::receiving_end::ReceivingEnd;
pub use self::sending_end::SenderEvent;
pub(super) use self::sending_end::SendingEnd;
