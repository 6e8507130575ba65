//! The variant over plain zenoh.

use super::batch_client::BatchClient;
use crate::worker::{Worker, print_line};
use crate::zenoh_peer::{Peer, Receiving, Sending, free_port, receive, send, wait_for_subscriber};
use scl::bytes::Bytes;
use std::time::Instant;
use tokio::runtime::Runtime;

/// The side that measures.
struct Client {
    ping: Sending,
    pong: Receiving,
    _peer: Peer,
}

pub(super) fn start(runtime: &Runtime, echo: &[&str]) -> scl::Result<(Box<dyn BatchClient>, Worker)> {
    let port = free_port()?;
    let peer = Peer::listen(port)?;
    let (ping, pong) = (peer.sending("bench/ping")?, peer.receiving("bench/pong")?);
    let mut echo = Worker::start(&[echo, &[&port.to_string()]].concat())?;
    wait_for_subscriber(&ping)?;
    let _ready = runtime.block_on(echo.next_line())?;
    Ok((Box::new(Client { ping, pong, _peer: peer }), echo))
}

impl BatchClient for Client {
    fn exchange(
        &mut self,
        _runtime: &Runtime,
        message: &Bytes,
        messages: usize,
        record: &mut dyn FnMut(Instant),
    ) -> scl::Result<()> {
        for _ in 0..messages {
            let started = Instant::now();
            send(&self.ping, message.clone())?;
            receive(&self.pong)?;
            record(started);
        }
        Ok(())
    }
}

/// Sends every message back.
pub(super) fn echo(port: &str) -> scl::Result<()> {
    let peer = Peer::connect(port.parse()?)?;
    let (ping, pong) = (peer.receiving("bench/ping")?, peer.sending("bench/pong")?);
    wait_for_subscriber(&pong)?;
    print_line("ready")?;
    loop {
        send(&pong, receive(&ping)?.payload().clone())?;
    }
}
