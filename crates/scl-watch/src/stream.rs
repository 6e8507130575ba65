//! The stream of one page: server-sent events with what has changed, and with the messages of the gate that it shows.

use crate::details::Details;
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
use tokio::time::{sleep, timeout};

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

impl Body for Stream {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        self.events.poll_recv(cx).map(|event| event.map(|event| Ok(Frame::data(event))))
    }
}

impl Stream {
    /// Starts a stream of a board, and of a gate.
    pub(crate) fn start(
        site: Arc<Site>,
        variant: usize,
        details: Option<Details>,
        permit: OwnedSemaphorePermit,
    ) -> Self {
        // One event: the next is made only when this one is written, so a slow browser gets fewer, not older ones.
        let (sender, events) = mpsc::channel(1);
        tokio::spawn(send_all(site, variant, details, sender));
        Self { events, _permit: permit }
    }
}

async fn send_all(site: Arc<Site>, variant: usize, mut details: Option<Details>, sender: mpsc::Sender<Bytes>) {
    let board = site.board(variant);
    let mut changes = board.watch();
    changes.mark_changed();
    let mut version = 0;
    loop {
        let next = async {
            match &mut details {
                Some(details) => details.next().await,
                None => pending().await,
            }
        };
        let event = tokio::select! {
            () = sender.closed() => return,
            changed = changes.changed() => {
                if changed.is_err() {
                    return;
                }
                let (values, newest) = board.since(version);
                version = newest;
                event("state", &Value::Object(values.into_iter().collect()))
            }
            shown = next => event("gate", &shown),
            () = sleep(KEEP_ALIVE) => Bytes::from_static(b":\n\n"),
        };
        if !matches!(timeout(PATIENCE, sender.send(event)).await, Ok(Ok(()))) {
            return;
        }
    }
}

/// An event: JSON has no line breaks outside of texts, and escapes them within.
fn event(name: &str, value: &Value) -> Bytes {
    Bytes::from(format!("event: {name}\ndata: {value}\n\n"))
}
