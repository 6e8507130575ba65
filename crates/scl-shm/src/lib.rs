//! Messages in shared memory under the connections of SCL, over iceoryx2.
//!
//! The connection's socket carries everything but the bytes of long messages: presence, order, credit and wake-up. This
//! crate lends memory to the sending end ([`SampleSender`]) and hands received memory out as [`bytes::Bytes`]
//! ([`SampleReceiver`]). It knows neither sockets nor gates.
//!
//! | file | contents |
//! |---|---|
//! | `node` | the node of this process in the folder of a system |
//! | `folder` | where the node's files are, their names, the lock, and removing unused ones |
//! | `unfinished` | removing files that a killed program had created and not filled |
//! | `service` | the service of one connection: its name and its settings |
//! | `sender`, `loaned` | lending memory and sending it |
//! | `receiver` | receiving memory |
//! | `limits` | how much memory a connection needs, and whether there is enough |
//! | `committed` | reserving memory before it is written, because too little of it would be a SIGBUS |
//! | `log` | what iceoryx2 logs |

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod committed;
mod error;
mod folder;
mod limits;
mod loaned;
mod log;
mod node;
mod receiver;
mod sender;
mod service;
#[cfg(test)]
mod tests;
mod unfinished;

pub use error::{LoanError, ReceiveError, SendError, ShmError};
pub use limits::{Limits, TooLittle, available};
pub use loaned::LoanedSample;
pub use node::SharedMemory;
pub use receiver::SampleReceiver;
pub use sender::SampleSender;
pub use service::ServiceName;

/// Two ends can share memory if their formats are equal: the version of the engine, and the width of pointers, on which
/// the layout of its files depends.
pub const FORMAT: &str = if cfg!(target_pointer_width = "64") { "iceoryx2-0.10-64" } else { "iceoryx2-0.10-32" };
