//! Routes at work: each is one task that joins an end in the runtime folder with an end of the wire.
//!
//! | route | where messages or requests leave | where they arrive |
//! |---|---|---|
//! | `pub` to `sub` | [`sending`]: subscribes in place of the subscriber | [`receiving`]: publishes in place of the publisher |
//! | `push` to `pull` | [`sending`]: pulls in place of the puller | [`receiving`]: pushes |
//! | `req` to `rep` | [`requesting`]: replies in place of the replier | [`replying`]: requests |
//!
//! A message is acknowledged to the component that sent it when the component at the far end has taken it, so queues,
//! waiting and flushes are those of the two components. While the far end is not there, neither is the near one, and
//! messages wait in the sending component.

mod counts;
mod local_end;
mod receiving;
mod replying;
mod requesting;
mod sending;

pub(crate) use counts::Counts;
pub(crate) use receiving::Receiving;
pub(crate) use replying::Replying;
pub(crate) use requesting::Requesting;
pub(crate) use sending::Sending;
