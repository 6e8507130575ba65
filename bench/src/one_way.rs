//! Messages in one direction, from this process to a worker: the basis of the benchmarks `rate` and `delay`.
//!
//! Each message starts with the time at which it, or its batch, is sent. The receiver reports each batch in one line.

mod batch_report;

pub(crate) use batch_report::BatchReport;

use crate::clock::now;
#[cfg(feature = "libzmq")]
use crate::ends::Sender;
use crate::link::{Far, Near, Setup};
use crate::message::Message;
use crate::runtime::{run, start_runtime};
use crate::variant::Variant;
use crate::worker::{print_line, unknown_arguments};
use scl::time::interval;
use std::time::Duration;
use tokio::runtime::Runtime;

pub(crate) const SCL_PUB: Variant = Variant { id: "scl-pub", name: "SCL pub/sub", baselines: &[] };
pub(crate) const ZEROMQ_PUB: Variant = Variant { id: "zeromq-pub", name: "zeromq XPUB/SUB", baselines: &[] };

/// What a receiver reports about a batch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Timing {
    /// The time of the whole batch. Its messages are identical, and no time is taken for each of them.
    Batch,
    /// Also the delay of each message.
    EachMessage,
}

/// The sending end of a variant, and the process that receives.
pub(crate) struct Channel {
    id: &'static str,
    near: Near,
    bytes: usize,
    batch: usize,
}

impl Channel {
    /// Starts the receiver and connects to it.
    pub(crate) async fn open(
        variant: Variant,
        folder: &str,
        bytes: usize,
        batch: usize,
        timing: Timing,
    ) -> scl::Result<Self> {
        let receiver = ["one-way", variant.id, folder, &bytes.to_string(), &batch.to_string(), timing.id()];
        let setup = Setup { id: variant.id, folder, bytes, is_round_trip: false, batch };
        Ok(Self { id: variant.id, near: Near::open(setup, &receiver).await?, bytes, batch })
    }

    /// Sends one batch as fast as possible.
    pub(crate) fn send_batch(&mut self, runtime: &Runtime) -> scl::Result<()> {
        #[cfg(feature = "libzmq")]
        if let Sender::LibzmqNodrop(publisher) = &mut self.near.sender {
            return publisher.trigger();
        }
        let message = Message::sent_now(self.bytes);
        let sender = &mut self.near.sender;
        run(runtime, self.id, async {
            for _ in 0..self.batch {
                sender.send(&message).await?;
            }
            Ok(())
        })
    }

    /// Sends one batch, one message per period. Not for blocking variants.
    pub(crate) async fn send_periodically(&mut self, period: Duration) -> scl::Result<()> {
        let mut interval = interval(period)?;
        for _ in 0..self.batch {
            interval.tick().await?;
            self.near.sender.send(&Message::sent_now(self.bytes)).await?;
        }
        Ok(())
    }

    /// Waits until the whole batch has arrived, and returns the receiver's report.
    pub(crate) async fn batch_report(&mut self) -> scl::Result<BatchReport> {
        BatchReport::parse(&self.near.worker.next_line().await?)
    }
}

/// Receives batches forever. The arguments are the variant's id, the scratch folder, the message size, the size of a
/// batch, and the timing.
pub(crate) fn run_receiver(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, bytes, batch, timing] = *arguments else { return Err(unknown_arguments(arguments)) };
    let (bytes, batch) = (bytes.parse()?, batch.parse()?);
    let times_each = timing == Timing::EachMessage.id();
    run(&start_runtime()?, id, async {
        let mut far = Far::open(Setup { id, folder, bytes, is_round_trip: false, batch }).await?;
        loop {
            // Measure from when the first message was sent, not received. Otherwise a sender that queues the whole
            // batch before it writes would look faster than one that writes at once.
            let first_sent = far.receiver.receive().await?.sent_time()?;
            let mut delays = Vec::with_capacity(if times_each { batch } else { 0 });
            if times_each {
                delays.push(now().saturating_sub(first_sent));
            }
            for _ in 1..batch {
                match times_each {
                    true => delays.push(now().saturating_sub(far.receiver.receive().await?.sent_time()?)),
                    false => far.receiver.skip().await?,
                }
            }
            let span = now().saturating_sub(first_sent);
            print_line(&BatchReport { span, delays }.to_line())?;
        }
    })
}

impl Timing {
    /// The word for this timing in the arguments of the receiver process.
    fn id(self) -> &'static str {
        match self {
            Self::Batch => "batch",
            Self::EachMessage => "each-message",
        }
    }
}
