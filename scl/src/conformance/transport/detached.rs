//! Calls without a runtime, as when a component is closed after its runtime has ended.

use super::requests;
use super::{PATTERNS, content, numbered};
use crate::conformance::PATIENCE;
use crate::transport::Transport;
use bytes::Bytes;
use std::future::poll_fn;
use std::task::Poll;
use std::time::{Duration, Instant};
use tokio::runtime::{Builder, Runtime};

/// A detached sender and its link deliver what is queued, and the receiver fetches it, while no runtime does anything.
pub async fn delivers_when_detached(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        let messages: Vec<Bytes> = numbered(500).into_iter().chain([content(1 << 20), content(1)]).collect();
        sender.queue(messages.clone());
        sender.detach();
        let mut received = Vec::new();
        tries(|| {
            assert!(sender.turn_detached(), "{pattern:?}: disconnected");
            received.extend(receiver.fetch(Duration::ZERO));
            received.len() >= messages.len() && sender.is_written()
        });
        assert!(received == messages, "{pattern:?}: {} of {} messages arrived", received.len(), messages.len());
    }
}

/// A detached sender still finds a receiver that is opened afterwards.
pub async fn accepts_peers_when_detached(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut sender = pattern.sender(transport);
        sender.detach();
        assert!(!sender.turn_detached(), "{pattern:?}: connected without a receiver");
        sender.queue(numbered(20));
        let mut receiver = pattern.receiver(transport);
        for expected in numbered(20) {
            let received = poll_fn(|cx| {
                sender.turn_detached();
                cx.waker().wake_by_ref();
                receiver.poll(cx)
            });
            assert_eq!(received.await, expected, "{pattern:?}");
        }
    }
}

/// A sender whose runtime has ended delivers what is queued once it is detached, and can be dropped.
pub async fn delivers_after_its_runtime_has_ended(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let runtime = OtherRuntime::new();
        let mut sender = runtime.inside(|| pattern.sender(transport));
        let mut receiver = pattern.receiver(transport);
        poll_fn(|cx| {
            assert!(receiver.poll(cx).is_pending(), "{pattern:?}: received a message that was not sent");
            if runtime.inside(|| sender.poll(cx)) { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        let messages: Vec<Bytes> = numbered(500).into_iter().chain([content(1 << 20), content(1)]).collect();
        sender.queue(messages.clone());
        drop(runtime);
        sender.detach();
        for expected in messages {
            let received = poll_fn(|cx| {
                assert!(sender.turn_detached(), "{pattern:?}: disconnected");
                cx.waker().wake_by_ref();
                receiver.poll(cx)
            });
            assert!(received.await == expected, "{pattern:?}: a message is damaged");
        }
        drop(sender);
    }
}

/// A detached replier writes the replies that were given, while no runtime does anything for it.
pub async fn replies_when_detached(transport: &dyn Transport) {
    for size in [0, 20, 1 << 20] {
        let (mut requester, mut replier) = requests::pair(transport).await;
        assert_eq!(requester.request(1, Bytes::from_static(b"question")), Ok(()));
        let request = requests::next_request(&mut requester, &mut replier).await;
        replier.end.detach();
        assert_eq!(request.path.reply(&request.envelope, content(size)), Ok(()), "the requester is connected");
        drop(request);
        let mut replier = Some(replier);
        let answer = poll_fn(|cx| {
            // Dropped as soon as everything is written, as when a component is closed.
            replier.take_if(|replier| replier.turn_detached());
            cx.waker().wake_by_ref();
            requester.poll_answer(cx)
        });
        assert!(requests::reply_of(answer.await) == (1, content(size)), "a reply of {size} bytes is damaged");
    }
}

/// Calls a function until it returns true, for at most [`PATIENCE`].
fn tries(mut call: impl FnMut() -> bool) {
    let started = Instant::now();
    while !call() && started.elapsed() < PATIENCE {
        std::thread::yield_now();
    }
}

/// A second runtime, which shuts down when it is dropped, even inside the first one.
struct OtherRuntime(Option<Runtime>);

impl OtherRuntime {
    fn new() -> Self {
        let built = Builder::new_multi_thread().worker_threads(1).enable_all().build();
        Self(Some(built.unwrap_or_else(|error| panic!("cannot create a runtime for the test: {error}"))))
    }

    fn inside<R>(&self, call: impl FnOnce() -> R) -> R {
        let _inside = self.0.as_ref().map(Runtime::enter);
        call()
    }
}

impl Drop for OtherRuntime {
    fn drop(&mut self) {
        if let Some(runtime) = self.0.take() {
            runtime.shutdown_background();
        }
    }
}
