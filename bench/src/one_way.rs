//! Messages in one direction, from this process to a worker: the basis of the benchmarks `rate` and `delay`.
//!
//! Each message starts with the time at which it, or its batch, is sent. The receiver reports each batch in one line.

mod batch;
mod batch_report;
mod components;
mod engines;
#[cfg(feature = "shm")]
mod iceoryx;
mod message;
mod receiver;
mod sender;
#[cfg(feature = "gateway")]
mod zenoh;

pub(crate) use batch_report::BatchReport;
pub(crate) use message::MIN_SIZE;
pub(crate) use receiver::run_receiver;

use crate::worker::Worker;
use message::Message;
use scl::time::interval;
use sender::Sender;
use std::time::Duration;
use tokio::runtime::Runtime;

/// A way to send messages: its name between the processes, and in the report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Variant {
    pub(crate) id: &'static str,
    pub(crate) name: &'static str,
}

pub(crate) const SCL_PUB: Variant = Variant { id: "scl-pub", name: "SCL pub/sub" };
pub(crate) const SCL_PUB_BLOCKING: Variant = Variant { id: "scl-pub-blocking", name: "SCL pub/sub (blocking)" };
pub(crate) const SCL_PUSH: Variant = Variant { id: "scl-push", name: "SCL push/pull" };
pub(crate) const SCL_PUSH_BLOCKING: Variant = Variant { id: "scl-push-blocking", name: "SCL push/pull (blocking)" };
pub(crate) const ZEROMQ_PUB: Variant = Variant { id: "zeromq-pub", name: "zeromq XPUB/SUB" };
pub(crate) const ZEROMQ_PUSH: Variant = Variant { id: "zeromq-push", name: "zeromq PUSH/PULL" };
pub(crate) const LIBZMQ_NODROP: Variant = Variant { id: "libzmq-nodrop", name: "libzmq XPUB_NODROP" };
pub(crate) const LIBZMQ_PUB: Variant = Variant { id: "libzmq-pub", name: "libzmq XPUB (no limit)" };
pub(crate) const LIBZMQ_PUSH: Variant = Variant { id: "libzmq-push", name: "libzmq PUSH" };
pub(crate) const LIBZMQ_PUSH_UNLIMITED: Variant =
    Variant { id: "libzmq-push-unlimited", name: "libzmq PUSH (no limit)" };
pub(crate) const UNIX: Variant = Variant { id: "unix", name: "Unix socket (tokio)" };
pub(crate) const SHM_LOAN: Variant = Variant { id: "shm-loan", name: "SCL shm, loaned" };
pub(crate) const SHM_LOAN_BLOCKING: Variant = Variant { id: "shm-loan-blocking", name: "SCL shm, loaned (blocking)" };
pub(crate) const SHM_COPY: Variant = Variant { id: "shm-copy", name: "SCL shm, copied" };
pub(crate) const SHM_COPY_BLOCKING: Variant = Variant { id: "shm-copy-blocking", name: "SCL shm, copied (blocking)" };
pub(crate) const ICEORYX_LOAN: Variant = Variant { id: "iceoryx-loan", name: "iceoryx2, loaned" };
pub(crate) const ICEORYX_COPY: Variant = Variant { id: "iceoryx-copy", name: "iceoryx2, copied" };
pub(crate) const IPC: Variant = Variant { id: "ipc", name: "SCL ipc" };
pub(crate) const IPC_BLOCKING: Variant = Variant { id: "ipc-blocking", name: "SCL ipc (blocking)" };
pub(crate) const TCP: Variant = Variant { id: "tcp", name: "SCL tcp" };
pub(crate) const GATEWAY: Variant = Variant { id: "gateway", name: "SCL over two gateways" };
pub(crate) const ZENOH: Variant = Variant { id: "zenoh", name: "zenoh" };

/// What a receiver reports about a batch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Timing {
    /// The time of the whole batch. Its messages are all the same, and nothing is done for each of them.
    Batch,
    /// Also the delay of each message.
    EachMessage,
}

/// The sending end of a variant, and the process that receives.
pub(crate) struct Channel {
    /// Dropped before the sender, which then cleans up for both.
    receiver: Worker,
    sender: Sender,
    bytes: usize,
    batch: usize,
}

impl Channel {
    /// Starts the receiver and connects to it. Messages have at least [`MIN_SIZE`] bytes.
    pub(crate) fn open(
        runtime: &Runtime,
        variant: Variant,
        folder: &str,
        bytes: usize,
        batch: usize,
        timing: Timing,
    ) -> scl::Result<Self> {
        let arguments = ["one-way", variant.id, folder, &bytes.to_string(), &batch.to_string(), timing.id()];
        let (sender, receiver) = Sender::start(runtime, variant.id, folder, &arguments, bytes, batch)?;
        Ok(Self { sender, receiver, bytes, batch })
    }

    /// Sends one batch as fast as possible.
    pub(crate) fn send_batch(&mut self, runtime: &Runtime) -> scl::Result<()> {
        self.sender.send_batch(runtime, &Message::new(self.bytes), self.batch)
    }

    /// Sends one batch, one message per period. Not for blocking variants.
    pub(crate) async fn send_periodically(&mut self, period: Duration) -> scl::Result<()> {
        let mut interval = interval(period)?;
        for _ in 0..self.batch {
            interval.tick().await?;
            self.sender.send(&Message::new(self.bytes)).await?;
        }
        Ok(())
    }

    /// Waits until the whole batch has arrived.
    pub(crate) async fn batch_report(&mut self) -> scl::Result<BatchReport> {
        BatchReport::parse(&self.receiver.next_line().await?)
    }
}

impl Timing {
    /// The name between the processes.
    fn id(self) -> &'static str {
        match self {
            Self::Batch => "batch",
            Self::EachMessage => "each-message",
        }
    }
}
