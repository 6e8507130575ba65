//! Messages: a publisher or pusher, up to three readers, and a model of each connection.
//!
//! | file | contents |
//! |---|---|
//! | `layout` | what is declared: kinds of gates, queues and their policies |
//! | `gates` | gates of different kinds behind one type |
//! | `message` | messages that can be told apart |
//! | `outbox` | model of a connection's queue at the sending gate |
//! | `transit` | model of what the transport has accepted and not delivered |
//! | `inbox` | model of the receiving gate |
//! | `model` | the connections of one sender together |
//! | `observed` | a transport that reports to the model what gates hand to it and get from it |
//! | `step` | the steps of a case |
//! | `stage` | the real gates, and what a step does to them |
//! | `check` | comparing the gates with the model |
//! | `ending` | the end of each case: everything that was not lost as declared must arrive |
//!
//! Because of `observed`, the model need not guess when a message is handed over, only whether it is the right one.

mod check;
mod ending;
mod gates;
mod inbox;
mod layout;
mod message;
mod model;
mod observed;
mod outbox;
mod stage;
mod step;
mod transit;

use crate::model::runner::run;
use crate::model::sockets;
use scl::transport::memory::Memory;
use stage::Stage;
use step::{Case, cases};
use transit::Promise;

#[test]
fn messages_in_memory_are_lost_only_as_declared() {
    run(1200, cases(40), async |case: &Case| Stage::new(case.layout, Memory::new(), Promise::Exact).play(case).await);
}

#[test]
fn messages_over_sockets_are_lost_only_as_declared_or_with_a_peer() {
    run(100, cases(40), async |case: &Case| {
        let (transport, _folder) = sockets();
        Stage::new(case.layout, transport, Promise::LostWithAPeer).play(case).await
    });
}
