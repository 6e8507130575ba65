//! The variant over plain zenoh.

use super::batch::{Batch, BatchReceiver, BatchSender};
use super::message::Message;
use crate::worker::{Worker, print_line, unknown_arguments};
use crate::zenoh_peer::{Peer, Receiving, Sending, free_port, receive, send, wait_for_subscriber};
use tokio::runtime::Runtime;

struct ZenohSender {
    stream: Sending,
    _peer: Peer,
}

struct ZenohReceiver {
    stream: Receiving,
    _peer: Peer,
}

pub(super) fn start(runtime: &Runtime, receiver: &[&str]) -> scl::Result<(Box<dyn BatchSender>, Worker)> {
    let port = free_port()?;
    let peer = Peer::listen(port)?;
    let stream = peer.sending("bench/stream")?;
    let mut receiver = Worker::start(&[receiver, &[&port.to_string()]].concat())?;
    let _ready = runtime.block_on(receiver.next_line())?;
    wait_for_subscriber(&stream)?;
    Ok((Box::new(ZenohSender { stream, _peer: peer }), receiver))
}

pub(super) fn open(rest: &[&str]) -> scl::Result<Box<dyn BatchReceiver>> {
    let [port] = rest else { return Err(unknown_arguments(rest)) };
    let peer = Peer::connect(port.parse()?)?;
    let stream = peer.receiving("bench/stream")?;
    print_line("ready")?;
    Ok(Box::new(ZenohReceiver { stream, _peer: peer }))
}

impl BatchSender for ZenohSender {
    fn send_batch(&mut self, _runtime: &Runtime, message: &Message, batch: usize) -> scl::Result<()> {
        for _ in 0..batch {
            send(&self.stream, message.payload.clone())?;
        }
        Ok(())
    }
}

impl BatchReceiver for ZenohReceiver {
    fn receive_batch(&mut self, _runtime: &Runtime, batch: &mut Batch) -> scl::Result<()> {
        while !batch.is_complete() {
            batch.add(&receive(&self.stream)?.payload().to_bytes())?;
        }
        Ok(())
    }
}
