//! The variants over plain iceoryx2.

use super::batch::{Batch, BatchReceiver, BatchSender};
use super::message::Message;
use crate::iceoryx::{Participant, Receiving, Sending, payload};
use crate::worker::{Worker, print_line};
use std::mem::MaybeUninit;
use tokio::runtime::Runtime;

struct IceoryxSender {
    stream: Sending,
    /// What is copied, unless messages are loaned.
    copied: Option<Vec<MaybeUninit<u8>>>,
    _participant: Participant,
}

struct IceoryxReceiver {
    stream: Receiving,
    _participant: Participant,
}

pub(super) fn start(
    runtime: &Runtime,
    id: &str,
    folder: &str,
    bytes: usize,
    receiver: &[&str],
) -> scl::Result<(Box<dyn BatchSender>, Worker)> {
    let participant = Participant::join()?;
    let stream = participant.sending(&format!("{folder}/{id}/stream"), bytes)?;
    let mut receiver = Worker::start(receiver)?;
    let _ready = runtime.block_on(receiver.next_line())?;
    let copied = (id == "iceoryx-copy").then(|| payload(&vec![7; bytes]));
    Ok((Box::new(IceoryxSender { stream, copied, _participant: participant }), receiver))
}

pub(super) fn open(id: &str, folder: &str) -> scl::Result<Box<dyn BatchReceiver>> {
    let participant = Participant::join()?;
    let stream = participant.receiving(&format!("{folder}/{id}/stream"))?;
    print_line("ready")?;
    Ok(Box::new(IceoryxReceiver { stream, _participant: participant }))
}

impl BatchSender for IceoryxSender {
    fn send_batch(&mut self, _runtime: &Runtime, message: &Message, batch: usize) -> scl::Result<()> {
        let time = message.time()?;
        for _ in 0..batch {
            match &self.copied {
                Some(copied) => self.stream.send_copied(copied, time)?,
                None => self.stream.send_loaned(message.payload.len(), time)?,
            }
        }
        Ok(())
    }
}

impl BatchReceiver for IceoryxReceiver {
    fn receive_batch(&mut self, _runtime: &Runtime, batch: &mut Batch) -> scl::Result<()> {
        while !batch.is_complete() {
            let received = self.stream.receive()?;
            batch.add(&received.user_header().to_be_bytes())?;
        }
        Ok(())
    }
}
