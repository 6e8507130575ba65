//! Ends that are moved between tasks and threads.

use super::{PATTERNS, numbered, requests};
use crate::conformance::PATIENCE;
use crate::transport::Transport;
use std::future::poll_fn;
use std::panic::resume_unwind;
use tokio::runtime::Handle;
use tokio::task::JoinHandle;
use tokio::time::timeout;

/// Where the next messages are sent and received.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// A task of the runtime.
    Task,
    /// A separate thread.
    Thread,
}

const PLACES: [(Place, Place); 4] = [
    (Place::Task, Place::Task),
    (Place::Thread, Place::Thread),
    (Place::Task, Place::Thread),
    (Place::Thread, Place::Task),
];

impl Place {
    /// Runs a future here.
    fn run<F: Future<Output: Send> + Send + 'static>(self, future: F) -> JoinHandle<F::Output> {
        match self {
            Self::Task => tokio::spawn(future),
            Self::Thread => {
                let runtime = Handle::current();
                // A runtime waits for its threads, so they must end even if the test fails.
                tokio::task::spawn_blocking(move || match runtime.block_on(async { timeout(PATIENCE, future).await }) {
                    Ok(output) => output,
                    Err(_elapsed) => panic!("an end in another thread is waiting for a wake-up"),
                })
            }
        }
    }
}

/// A connected sender and receiver can be moved to other tasks and threads, and go on there.
pub async fn moves_between_threads(transport: &dyn Transport) {
    const MESSAGES: u32 = 500;
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        for (sends, receives) in PLACES {
            sender.renew_waker();
            receiver.watched.renew_waker();
            sender.queue(numbered(MESSAGES));
            let sending = sends.run(async move {
                sender.until_written().await;
                sender
            });
            let receiving = receives.run(async move {
                for expected in numbered(MESSAGES) {
                    assert_eq!(receiver.next(&mut []).await, expected, "{pattern:?} from {sends:?} to {receives:?}");
                }
                receiver
            });
            sender = joined(sending).await;
            receiver = joined(receiving).await;
        }
    }
}

/// A connected requester and replier can be moved to other tasks and threads, and go on there.
pub async fn moves_requests_between_threads(transport: &dyn Transport) {
    const REQUESTS: u64 = 50;
    let (mut requester, mut replier) = requests::pair(transport).await;
    for (requests, replies) in PLACES {
        requester.renew_waker();
        replier.renew_waker();
        let requesting = requests.run(async move {
            for id in 0..REQUESTS {
                poll_fn(|cx| requester.poll_connected(cx)).await;
                assert_eq!(requester.request(id, requests::text(b'q', id)), Ok(()), "the replier is connected");
                let reply = requests::reply_of(poll_fn(|cx| requester.poll_answer(cx)).await);
                assert_eq!(reply, (id, requests::text(b'q', id)), "{requests:?} to {replies:?}");
            }
            requester
        });
        let replying = replies.run(async move {
            for _ in 0..REQUESTS {
                let request = poll_fn(|cx| replier.poll(cx)).await;
                assert_eq!(request.path.reply(&request.envelope, request.body), Ok(()), "the requester is connected");
            }
            poll_fn(|cx| replier.poll_written(cx)).await;
            replier
        });
        requester = joined(requesting).await;
        replier = joined(replying).await;
    }
}

async fn joined<R>(running: JoinHandle<R>) -> R {
    match running.await {
        Ok(output) => output,
        Err(failed) => resume_unwind(failed.into_panic()),
    }
}
