//! The side that sends first, and measures.

use super::components;
use crate::processes::{OtherProcess, wrong_words};
use crate::raw::{self, RawPlace};
use scl::bytes::Bytes;
use std::os::unix::net::{UnixListener as StdUnixListener, UnixStream as StdUnixStream};
use std::time::{Duration, Instant};
use tokio::net::{UnixListener, UnixStream};
use tokio::runtime::Runtime;
use zeromq::{DealerSocket, Socket, SocketRecv, SocketSend, SubSocket, XPubSocket};

/// How long the two sides may take to find each other.
const PATIENCE: Duration = Duration::from_secs(10);

/// One way there and back.
pub(super) enum Ball {
    Async(AsyncBall),
    Blocking(BlockingBall),
}

/// Ways that are played on the async runtime.
pub(super) enum AsyncBall {
    SclPublish(components::Ball),
    SclCall(components::Ball),
    RawPublish { there: XPubSocket, back: SubSocket },
    RawCall(DealerSocket),
    Unix(UnixStream),
}

/// Ways that are played on a plain thread.
pub(super) enum BlockingBall {
    SclPublish(components::Ball),
    SclCall(components::Ball),
    #[cfg(feature = "libzmq")]
    Libzmq(super::libzmq::Ball),
    Unix(StdUnixStream),
}

impl Ball {
    /// Starts the other side of a way and connects to it.
    pub(super) fn start(
        runtime: &Runtime,
        word: &str,
        folder: &str,
        bytes: usize,
    ) -> scl::Result<(Self, OtherProcess)> {
        let wall = ["roundtrip", word, folder, &bytes.to_string()];
        if word.ends_with("-blocking") {
            let (ball, wall) = BlockingBall::start(word, folder, &wall)?;
            return Ok((Self::Blocking(ball), wall));
        }
        let (ball, wall) = runtime.block_on(AsyncBall::start(word, folder, &wall))?;
        Ok((Self::Async(ball), wall))
    }

    /// Sends so many messages, each when the one before is back; hands each time to `record`, in nanoseconds.
    pub(super) fn throw(
        &mut self,
        runtime: &Runtime,
        payload: &Bytes,
        messages: usize,
        record: &mut dyn FnMut(u64),
    ) -> scl::Result<()> {
        let mut answer = vec![0; payload.len()];
        let mut measured = |started: Instant| record(started.elapsed().as_nanos().try_into().unwrap_or(u64::MAX));
        match self {
            Self::Async(ball) => runtime.block_on(async {
                for _ in 0..messages {
                    let started = Instant::now();
                    ball.exchange(payload, &mut answer).await?;
                    measured(started);
                }
                Ok(())
            }),
            Self::Blocking(ball) => {
                for _ in 0..messages {
                    let started = Instant::now();
                    ball.exchange(payload, &mut answer)?;
                    measured(started);
                }
                Ok(())
            }
        }
    }
}

impl AsyncBall {
    async fn start(word: &str, folder: &str, wall: &[&str]) -> scl::Result<(Self, OtherProcess)> {
        let place = RawPlace::new(folder, word);
        match word {
            "scl-publish" | "scl-call" => {
                let wall = OtherProcess::start(wall)?;
                let options = scl::OpenOptions::new().runtime_dir(folder).system(word);
                let ball = components::Ball::open_with(options).await?;
                ball.ready(PATIENCE).await?;
                Ok((if word == "scl-call" { Self::SclCall(ball) } else { Self::SclPublish(ball) }, wall))
            }
            "raw-publish" => {
                let mut there = place.publish("there").await?;
                let mut wall = OtherProcess::start(wall)?;
                wall.line().await?;
                let back = place.subscribe("back").await?;
                // The wall's subscription.
                there.recv().await?;
                Ok((Self::RawPublish { there, back }, wall))
            }
            "raw-call" => {
                let mut wall = OtherProcess::start(wall)?;
                wall.line().await?;
                let mut socket = DealerSocket::new();
                socket.connect(&place.zeromq("question")).await?;
                Ok((Self::RawCall(socket), wall))
            }
            "unix" => {
                let listener = UnixListener::bind(place.socket("stream"))?;
                let wall = OtherProcess::start(wall)?;
                Ok((Self::Unix(listener.accept().await?.0), wall))
            }
            other => Err(wrong_words(&[other])),
        }
    }

    async fn exchange(&mut self, payload: &Bytes, answer: &mut [u8]) -> scl::Result<()> {
        match self {
            Self::SclPublish(ball) => {
                ball.there.send(payload).await?;
                ball.back.recv().await?;
            }
            Self::SclCall(ball) => drop(ball.question.call(payload).await?),
            Self::RawPublish { there, back } => {
                there.send(payload.clone().into()).await?;
                back.recv().await?;
            }
            Self::RawCall(socket) => {
                socket.send(raw::question(payload)).await?;
                socket.recv().await?;
            }
            Self::Unix(stream) => raw::exchange(stream, payload, answer).await?,
        }
        Ok(())
    }
}

impl BlockingBall {
    fn start(word: &str, folder: &str, wall: &[&str]) -> scl::Result<(Self, OtherProcess)> {
        match word {
            "scl-publish-blocking" | "scl-call-blocking" => {
                let wall = OtherProcess::start(wall)?;
                let options = scl::OpenOptions::new().runtime_dir(folder).system(word);
                let ball = components::Ball::open_blocking_with(options)?;
                ball.ready_blocking(PATIENCE)?;
                Ok((if word == "scl-call-blocking" { Self::SclCall(ball) } else { Self::SclPublish(ball) }, wall))
            }
            #[cfg(feature = "libzmq")]
            "libzmq-publish-blocking" | "libzmq-call-blocking" => {
                let (ball, wall) = super::libzmq::Ball::start(word, folder, wall)?;
                Ok((Self::Libzmq(ball), wall))
            }
            "unix-blocking" => {
                let listener = StdUnixListener::bind(RawPlace::new(folder, word).socket("stream"))?;
                let wall = OtherProcess::start(wall)?;
                Ok((Self::Unix(listener.accept()?.0), wall))
            }
            other => Err(wrong_words(&[other])),
        }
    }

    fn exchange(&mut self, payload: &Bytes, answer: &mut [u8]) -> scl::Result<()> {
        match self {
            Self::SclPublish(ball) => {
                ball.there.send_blocking(payload)?;
                ball.back.recv_blocking()?;
            }
            Self::SclCall(ball) => drop(ball.question.call_blocking(payload)?),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(ball) => ball.exchange(payload)?,
            Self::Unix(stream) => raw::exchange_blocking(stream, payload, answer)?,
        }
        Ok(())
    }
}
