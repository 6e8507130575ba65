//! The variants over plain iceoryx2, on plain threads as its users have them.

use super::batch_client::BatchClient;
use crate::clock::now;
use crate::iceoryx::{Participant, Receiving, Sending, payload};
use crate::worker::{Worker, print_line};
use scl::bytes::Bytes;
use std::mem::MaybeUninit;
use std::time::Instant;
use tokio::runtime::Runtime;

/// The side that measures. Fields are dropped in this order, and a participant cleans up last.
struct Client {
    ping: Sending,
    pong: Receiving,
    /// What is copied, unless messages are loaned.
    copied: Option<Vec<MaybeUninit<u8>>>,
    _participant: Participant,
}

pub(super) fn start(
    runtime: &Runtime,
    id: &str,
    folder: &str,
    bytes: usize,
    echo: &[&str],
) -> scl::Result<(Box<dyn BatchClient>, Worker)> {
    let participant = Participant::join()?;
    let ping = participant.sending(&format!("{folder}/{id}/ping"), bytes)?;
    let pong = participant.receiving(&format!("{folder}/{id}/pong"))?;
    let mut echo = Worker::start(echo)?;
    let _ready = runtime.block_on(echo.next_line())?;
    let copied = (id == "iceoryx-copy").then(|| payload(&vec![7; bytes]));
    Ok((Box::new(Client { ping, pong, copied, _participant: participant }), echo))
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
            match &self.copied {
                Some(copied) => self.ping.send_copied(copied, 0)?,
                None => self.ping.send_loaned(message.len(), 0)?,
            }
            self.pong.receive()?;
            record(started);
        }
        Ok(())
    }
}

/// Sends every message back: copied, or as a new loan of the same size.
pub(super) fn echo(id: &str, folder: &str, bytes: usize) -> scl::Result<()> {
    let participant = Participant::join()?;
    let ping = participant.receiving(&format!("{folder}/{id}/ping"))?;
    let pong = participant.sending(&format!("{folder}/{id}/pong"), bytes)?;
    print_line("ready")?;
    loop {
        let received = ping.receive()?;
        match id {
            "iceoryx-copy" => pong.send_copied(received.payload(), now())?,
            _ => pong.send_loaned(received.payload().len(), now())?,
        }
    }
}
