//! A stream of messages from one gateway to another: in order, each at most once, with credit, over a network library
//! that drops messages silently.
//!
//! The sending end keeps a message until the receiving component has taken it, and never more of them than the window.
//! Losses show as a gap in the numbers, or when a probe, which travels behind the messages, is answered; then the
//! sending end starts over after what has arrived. `outgoing` and `incoming` decide, without I/O; the ends carry it
//! out.

mod incoming;
mod outgoing;
mod receiving_end;
mod sending_end;

pub use self::receiving_end::ReceiverEvent;
pub(super) use self::receiving_end::ReceivingEnd;
pub use self::sending_end::SenderEvent;
pub(super) use self::sending_end::SendingEnd;
