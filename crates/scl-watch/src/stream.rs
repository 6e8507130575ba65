//! The stream of one page: server-sent events with what has changed, and with the messages of the gate or the log of
//! the component that it shows.

use crate::details::Details;
use crate::log::Log;
use crate::site::Site;
use hyper::body::{Body, Bytes, Frame};
use serde_json::Value;
use std::convert::Infallible;
use std::future::pending;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, mpsc};
use tokio::time::{Instant, sleep_until, timeout};

/// The time after which an empty comment is sent, so that both ends notice a connection that is gone.
const KEEP_ALIVE: Duration = Duration::from_secs(10);
/// How long a browser may leave an event unread until its stream is ended.
const PATIENCE: Duration = Duration::from_secs(60);

/// The body of the response.
pub(crate) struct Stream {
    events: mpsc::Receiver<Bytes>,
    /// Counts the streams.
    _permit: OwnedSemaphorePermit,
}

/// Where the events of a page go.
pub(crate) struct Events {
    sender: mpsc::Sender<Bytes>,
    latest: Instant,
}

/// What a page of a running system shows beside the picture.
pub(crate) struct Chosen {
    pub(crate) gate: Option<Details>,
    pub(crate) log: Option<Log>,
}

impl Body for Stream {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        self.events.poll_recv(cx).map(|event| event.map(|event| Ok(Frame::data(event))))
    }
}

impl Stream {
    /// Makes the two ends of a stream.
    pub(crate) fn new(permit: OwnedSemaphorePermit) -> (Events, Self) {
        // One event: the next is made only when this one is written, so a slow browser gets fewer, not older ones.
        let (sender, events) = mpsc::channel(1);
        (Events { sender, latest: Instant::now() }, Self { events, _permit: permit })
    }
}

impl Events {
    /// Waits until the page has closed.
    pub(crate) async fn closed(&self) {
        self.sender.closed().await;
    }

    /// Sends an event. False if the page is gone, or does not read.
    pub(crate) async fn send(&mut self, name: &str, value: &Value) -> bool {
        // JSON has no line breaks outside of texts, and escapes them within.
        self.write(format!("event: {name}\ndata: {value}\n\n").into()).await
    }

    /// Waits until nothing was sent for a while.
    pub(crate) async fn quiet(&self) {
        sleep_until(self.latest + KEEP_ALIVE).await;
    }

    /// Sends nothing, to learn whether the page is still there.
    pub(crate) async fn keep_alive(&mut self) -> bool {
        self.write(Bytes::from_static(b":\n\n")).await
    }

    async fn write(&mut self, event: Bytes) -> bool {
        self.latest = Instant::now();
        matches!(timeout(PATIENCE, self.sender.send(event)).await, Ok(Ok(())))
    }
}

/// Sends what changes on a board, and what is chosen, until the page closes.
pub(crate) async fn send_all(site: Arc<Site>, variant: usize, mut chosen: Chosen, mut events: Events) {
    let board = site.board(variant);
    let mut changes = board.watch();
    changes.mark_changed();
    let mut version = 0;
    loop {
        let of_gate = async {
            match &mut chosen.gate {
                Some(gate) => gate.next().await,
                None => pending().await,
            }
        };
        let of_log = async {
            match &mut chosen.log {
                Some(log) => log.next().await,
                None => pending().await,
            }
        };
        let is_sent = tokio::select! {
            () = events.closed() => return,
            changed = changes.changed() => {
                if changed.is_err() {
                    return;
                }
                let (values, newest) = board.since(version);
                version = newest;
                events.send("state", &values.into_iter().collect()).await
            }
            shown = of_gate => events.send("gate", &shown).await,
            shown = of_log => events.send("log", &shown).await,
            () = events.quiet() => events.keep_alive().await,
        };
        if !is_sent {
            return;
        }
    }
}
