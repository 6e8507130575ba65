//! A TCP proxy between two gateways that can cut, stall, delay and throttle.

use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{mpsc, watch};
use tokio::time::Instant;

/// What the link is like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weather {
    Good,
    /// Connections are closed and refused.
    Cut,
    /// Connections stay, and nothing passes.
    Stalled,
    /// Everything is late.
    Delayed(Duration),
    /// Bytes per second in each direction.
    Throttled(u64),
}

pub(crate) struct Proxy {
    pub(crate) address: String,
    weather: watch::Sender<Weather>,
    closed: watch::Receiver<usize>,
}

impl Proxy {
    pub(crate) async fn to(target: &str) -> Proxy {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("no free port");
        let address = listener.local_addr().expect("address").to_string();
        let (weather, watcher) = watch::channel(Weather::Good);
        let (counter, closed) = watch::channel(0);
        tokio::spawn(accept(listener, target.to_owned(), watcher, counter));
        Proxy { address, weather, closed }
    }

    /// Number of connections that began and ended.
    pub(crate) fn closed(&self) -> watch::Receiver<usize> {
        self.closed.clone()
    }

    pub(crate) fn set(&self, weather: Weather) {
        let _ = self.weather.send(weather);
    }
}

async fn accept(
    listener: TcpListener,
    target: String,
    weather: watch::Receiver<Weather>,
    closed: watch::Sender<usize>,
) {
    while let Ok((near, _)) = listener.accept().await {
        if *weather.borrow() == Weather::Cut {
            continue;
        }
        let Ok(far) = TcpStream::connect(&target).await else { continue };
        let ((near_read, near_write), (far_read, far_write)) = (near.into_split(), far.into_split());
        let mut cut = weather.clone();
        let closed = closed.clone();
        let (up, down) = (weather.clone(), weather.clone());
        tokio::spawn(async move {
            tokio::select! {
                _ = forward(near_read, far_write, up) => (),
                _ = forward(far_read, near_write, down) => (),
                _ = cut.wait_for(|weather| *weather == Weather::Cut) => (),
            }
            closed.send_modify(|closed| *closed += 1);
        });
    }
}

async fn forward(mut from: OwnedReadHalf, mut to: OwnedWriteHalf, mut weather: watch::Receiver<Weather>) -> Option<()> {
    // The few chunks in between are the buffer of the slow link, so that the sender notices.
    let (queue, mut queued) = mpsc::channel::<(Instant, Vec<u8>)>(64);
    let reading = async {
        loop {
            let mut chunk = vec![0; 4096];
            let length = from.read(&mut chunk).await.ok().filter(|length| *length > 0)?;
            chunk.truncate(length);
            queue.send((Instant::now(), chunk)).await.ok()?;
        }
    };
    let writing = async {
        loop {
            let (at, chunk) = queued.recv().await?;
            let weather = *weather.wait_for(|weather| *weather != Weather::Stalled).await.ok()?;
            match weather {
                Weather::Delayed(delay) => tokio::time::sleep_until(at + delay).await,
                Weather::Throttled(rate) => {
                    tokio::time::sleep(Duration::from_micros(chunk.len() as u64 * 1_000_000 / rate)).await;
                }
                _ => (),
            }
            to.write_all(&chunk).await.ok()?;
        }
    };
    tokio::select! {
        outcome = reading => outcome,
        outcome = writing => outcome,
    }
}
