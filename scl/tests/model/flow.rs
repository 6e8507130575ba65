//! What is sent: a publisher or pusher, up to three receivers, and the model of each connection.
//!
//! | file | what it knows |
//! |---|---|
//! | `layout` | what is declared: kinds of gates, queues and what they do when they are full |
//! | `gates` | the gates, whichever kind they are of |
//! | `message` | messages that can be told apart |
//! | `held` | the model of a connection's sending end |
//! | `way` | what the transport promises in between |
//! | `inbox` | the model of the receiving gate |
//! | `model` | the connections of one sender together |
//! | `ledger` | a transport that tells the model what crosses the border between gates and transport |
//! | `step` | the steps that a case consists of |
//! | `stage` | the real gates, and how a step is done to them |
//! | `check` | comparing the gates with the model |
//! | `ending` | the end of each case, when everything that was not lost as declared has to arrive |
//!
//! The ledger makes the model exact: it need not guess when a message is handed over, only whether it is the right one.

mod check;
mod ending;
mod gates;
mod held;
mod inbox;
mod layout;
mod ledger;
mod message;
mod model;
mod stage;
mod step;
mod way;

use crate::sockets;
use crate::trial::trial;
use scl::transport::memory::Memory;
use stage::Stage;
use step::{Case, cases};
use way::Promise;

#[test]
fn messages_in_memory_are_lost_only_as_declared() {
    trial(1200, cases(40), async |case: &Case| Stage::new(case.layout, Memory::new(), Promise::Exact).play(case).await);
}

#[test]
fn messages_over_sockets_are_lost_only_as_declared_or_with_a_peer() {
    trial(100, cases(40), async |case: &Case| {
        let (transport, _folder) = sockets();
        Stage::new(case.layout, transport, Promise::LostWithAPeer).play(case).await
    });
}
