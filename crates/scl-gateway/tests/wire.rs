//! The wire: several of them in one process, over loopback.

mod certificates;
mod faults;
mod messages;
mod neighbours;
mod network;
pub(crate) mod proxy;
mod requests;
mod tls;
