//! Components of two hosts and their gateways in one process, over loopback: the components are those of `scl`, and
//! know nothing of gateways.
#![allow(clippy::unwrap_used)]

mod accounts;
mod hosts;
mod latched;
mod messages;
mod outages;
mod presence;
mod requests;
mod restarts;
