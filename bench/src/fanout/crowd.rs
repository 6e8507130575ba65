//! A publisher and the eight processes that listen to it.

use super::components::Source;
use super::message::Message;
use super::{Measured, PERIOD, SINKS};
use crate::one_way::Received;
use crate::processes::{OtherProcess, wrong_words};
use crate::raw::RawPlace;
use scl::bytes::Bytes;
use scl::time::interval;
use std::time::{Duration, Instant};
use zeromq::{PubSocket, Socket, SocketSend};

const PATIENCE: Duration = Duration::from_secs(10);

/// Messages until a listener that gets none is given up: [`PATIENCE`] of them.
const SETTLING: usize = 10_000;

pub(super) struct Crowd {
    publisher: Publisher,
    /// The one that is stopped now and then.
    stopped: OtherProcess,
    others: Vec<OtherProcess>,
    /// The last one sent; each has its own number, so that old messages are told from new ones.
    batch: u32,
}

/// The sending end of a way.
enum Publisher {
    Scl(Source),
    Raw(PubSocket),
}

impl Crowd {
    /// Starts all of them; every listener has had a message when this returns.
    pub(super) async fn start(word: &str, folder: &str) -> scl::Result<Self> {
        let start_sink = |number: usize| OtherProcess::start(&["fanout", word, folder, &number.to_string()]);
        let publisher = Publisher::open(word, folder).await?;
        let stopped = start_sink(1)?;
        let others = (2..=SINKS).map(start_sink).collect::<scl::Result<_>>()?;
        if let Publisher::Scl(source) = &publisher {
            source.ready(PATIENCE).await?;
        }
        let mut crowd = Self { publisher, stopped, others, batch: 0 };
        crowd.settle().await?;
        Ok(crowd)
    }

    /// Sends a batch, a message each period, and records how long each took to send and to arrive at the other seven.
    pub(super) async fn play(&mut self, messages: u32, measured: &mut Measured) -> scl::Result<()> {
        self.batch += 1;
        let mut tick = interval(PERIOD)?;
        for following in (0..messages).rev() {
            tick.tick().await;
            let message = Message::new(self.batch, following).encode();
            let started = Instant::now();
            self.publisher.send(message).await?;
            measured.sends.record(started.elapsed().as_nanos().try_into()?);
        }
        for sink in &mut self.others {
            let delays = delays_of(sink, self.batch).await?;
            measured.lost += u64::from(messages).saturating_sub(delays.len() as u64);
            delays.into_iter().for_each(|delay| measured.delays.record(delay));
        }
        Ok(())
    }

    /// Stops one listener when it has got all that was sent.
    pub(super) async fn stop_one(&mut self) -> scl::Result<()> {
        delays_of(&mut self.stopped, self.batch).await?;
        self.stopped.stop()
    }

    /// The stopped one goes on; gives the delays of what it still gets of the last batch, when it has read all of it.
    pub(super) async fn let_it_go_on(&mut self) -> scl::Result<Vec<u64>> {
        if self.stopped.has_said_more() {
            return Err(scl::Error::message("the subscriber that was to stand still went on by itself"));
        }
        self.stopped.go_on()?;
        delays_of(&mut self.stopped, self.batch).await
    }

    /// Sends until everybody has seen a new message, so that nobody misses any from then on.
    async fn settle(&mut self) -> scl::Result<()> {
        let mut tick = interval(PERIOD)?;
        let (first, mut sent) = (self.batch + 1, 0);
        for sink in std::iter::once(&mut self.stopped).chain(&mut self.others) {
            loop {
                tokio::select! {
                    seen = delays_of(sink, first) => {
                        seen?;
                        break;
                    }
                    () = tick.tick() => {}
                }
                self.batch += 1;
                sent += 1;
                if sent > SETTLING {
                    return Err(scl::Error::message("a subscriber was sent messages for 10 s and got none of them"));
                }
                // A batch of one: whoever gets it says so.
                self.publisher.send(Message::new(self.batch, 0).encode()).await?;
            }
        }
        Ok(())
    }
}

/// Waits until a listener has got the last message of a batch, or of a later one.
async fn delays_of(sink: &mut OtherProcess, batch: u32) -> scl::Result<Vec<u64>> {
    loop {
        let said = Received::parse(&sink.line().await?)?;
        if said.span >= batch.into() {
            return Ok(said.delays);
        }
    }
}

impl Publisher {
    async fn open(word: &str, folder: &str) -> scl::Result<Self> {
        match word {
            "scl" => {
                let options = scl::OpenOptions::new().runtime_dir(folder).system(word);
                Ok(Self::Scl(Source::open_with(options).await?))
            }
            "raw" => {
                let mut socket = PubSocket::new();
                socket.bind(&RawPlace::new(folder, word).zeromq("stream")).await?;
                Ok(Self::Raw(socket))
            }
            other => Err(wrong_words(&[other])),
        }
    }

    async fn send(&mut self, message: Bytes) -> scl::Result<()> {
        match self {
            Self::Scl(source) => source.stream.send(&message).await?,
            Self::Raw(socket) => socket.send(message.into()).await?,
        }
        Ok(())
    }
}
