//! A publisher and its eight subscriber processes.

use super::message::{Message, PERIOD};
use crate::components::fanout::Publisher as Component;
use crate::durations::Durations;
use crate::ends::{Calls, Sender};
use crate::link::{CONNECT_TIMEOUT, connect, open};
use crate::one_way::BatchReport;
use crate::raw::SocketPaths;
use crate::worker::Worker;
use scl::time::interval;
use std::time::Instant;
use zeromq::PubSocket;

/// The number of subscribers, as in the topology.
pub(super) const SUBSCRIBERS: usize = 8;

/// Number of messages to send before giving up on a subscriber that has received none; sending them takes
/// [`CONNECT_TIMEOUT`].
const MAX_UNRECEIVED: usize = 10_000;

pub(super) struct Publisher {
    socket: Sender,
    /// The subscriber that is stopped from time to time.
    stopped: Worker,
    others: Vec<Worker>,
    /// The number of the last batch that was sent, to tell old messages from new ones.
    batch: u32,
}

impl Publisher {
    /// Starts all processes. When this returns, every subscriber has received a message.
    pub(super) async fn start(id: &str, folder: &str) -> scl::Result<Self> {
        let start_subscriber = |number: usize| Worker::start(&["fanout", id, folder, &number.to_string()]);
        let raw = match id {
            "zeromq" => Some(SocketPaths::new(folder, id).bind::<PubSocket>("stream").await?),
            _ => None,
        };
        let stopped = start_subscriber(1)?;
        let others = (2..=SUBSCRIBERS).map(start_subscriber).collect::<scl::Result<_>>()?;
        let socket = match raw {
            Some(socket) => Sender::Zeromq(Box::new(socket)),
            None => {
                let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
                Sender::Pub(connect!(Component, options, false).stream, Calls::default())
            }
        };
        let mut publisher = Self { socket, stopped, others, batch: 0 };
        publisher.reach_all().await?;
        Ok(publisher)
    }

    /// Sends a batch, one message per period, and records how long each send takes.
    pub(super) async fn send_batch(&mut self, messages: u32, sends: &mut Durations) -> scl::Result<()> {
        self.batch += 1;
        let mut interval = interval(PERIOD)?;
        for remaining in (0..messages).rev() {
            interval.tick().await?;
            let message = Message::new(self.batch, remaining).encode();
            let started = Instant::now();
            self.socket.send(&message.into()).await?;
            sends.record(started.elapsed().as_nanos().try_into()?);
        }
        Ok(())
    }

    /// Waits until the subscribers that are never stopped have received the batch, and returns its delays for each.
    pub(super) async fn delays_of_others(&mut self) -> scl::Result<Vec<Vec<u64>>> {
        let mut delays = Vec::with_capacity(self.others.len());
        for subscriber in &mut self.others {
            delays.push(delays_of(subscriber, self.batch).await?);
        }
        Ok(delays)
    }

    /// Stops one subscriber after it has received everything that was sent.
    pub(super) async fn stop_one(&mut self) -> scl::Result<()> {
        delays_of(&mut self.stopped, self.batch).await?;
        self.stopped.stop()
    }

    /// Resumes the stopped subscriber, and returns the delays of what it still receives of the last batch.
    pub(super) async fn resume_one(&mut self) -> scl::Result<Vec<u64>> {
        if self.stopped.try_next_line()?.is_some() {
            return Err(scl::Error::message("the stopped subscriber was resumed by another program"));
        }
        self.stopped.resume()?;
        delays_of(&mut self.stopped, self.batch).await
    }

    /// Sends until every subscriber has received a new message, so that none is missed from then on.
    async fn reach_all(&mut self) -> scl::Result<()> {
        let mut interval = interval(PERIOD)?;
        let (first, mut sent) = (self.batch + 1, 0);
        for subscriber in std::iter::once(&mut self.stopped).chain(&mut self.others) {
            loop {
                tokio::select! {
                    delays = delays_of(subscriber, first) => {
                        delays?;
                        break;
                    }
                    tick = interval.tick() => tick?,
                }
                self.batch += 1;
                sent += 1;
                if sent > MAX_UNRECEIVED {
                    return Err(scl::Error::message("a subscriber received nothing for 10 s"));
                }
                // A batch of one message, so each subscriber reports it at once.
                self.socket.send(&Message::new(self.batch, 0).encode().into()).await?;
            }
        }
        Ok(())
    }
}

/// Waits until a subscriber has received the last message of this batch or of a later one, and returns the delays that
/// it reports.
async fn delays_of(subscriber: &mut Worker, batch: u32) -> scl::Result<Vec<u64>> {
    loop {
        let report = BatchReport::parse(&subscriber.next_line().await?)?;
        // In this benchmark, a subscriber reports the number of the batch in place of its span.
        if report.span >= batch.into() {
            return Ok(report.delays);
        }
    }
}
