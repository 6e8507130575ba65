//! A gate whose queue is full does not look at its peers. It must do so again when its program has received a message,
//! although the program may not receive another one for long: a sender that closes waits for the gate's answer.
#![allow(clippy::unwrap_used)]

use super::untyped::on_each_transport_async;
use scl::runtime_dir::{ComponentStats, RuntimeDir};
use scl::{OpenOptions, TransportKind};
use std::path::Path;
use std::time::{Duration, Instant};

scl::topology!("full_queue.yaml");

const LONG: Duration = Duration::from_secs(300);

/// Fills the queue of a gate, lets its sender close, and receives what is in the queue.
macro_rules! a_sender_can_close {
    ($name:ident, $gate:ident, $queue:literal) => {
        #[test]
        fn $name() {
            on_each_transport_async(|options| async move {
                let mut source = Source::open_with(options.clone()).await.unwrap();
                let mut sink = Sink::open_with(options).await.unwrap();
                for number in 0..$queue {
                    source.$gate.send(&number).await.unwrap();
                }
                until(|| sink.$gate.stats().waiting == $queue).await;
                let received = async {
                    // Until the question of the sender has arrived.
                    for _ in 0..100 {
                        tokio::task::yield_now().await;
                    }
                    for number in 0..$queue {
                        assert_eq!(sink.$gate.try_recv().unwrap(), Some(number));
                    }
                };
                let (closed, ()) = tokio::join!(source.close(LONG), received);
                closed.unwrap();
            });
        }
    };
}

a_sender_can_close!(after_a_subscriber_has_received, readings, 3);
a_sender_can_close!(after_a_subscriber_to_the_newest_has_received, newest, 1);
a_sender_can_close!(after_a_puller_has_received, jobs, 2);

#[tokio::test]
async fn what_a_subscriber_passes_over_is_told_to_its_publisher() {
    let folder = tempfile::tempdir().unwrap();
    let options = OpenOptions::new().runtime_dir(folder.path()).transport_kind(TransportKind::Ipc);
    let mut source = Source::open_with(options.clone()).await.unwrap();
    let mut sink = Sink::open_with(options).await.unwrap();
    for number in 0..5 {
        source.readings.send(&number).await.unwrap();
    }
    until(|| sink.readings.stats().waiting == 3).await;
    source_has_asked(folder.path()).await;
    assert_eq!(sink.readings.latest().unwrap(), Some(4));
    until(|| source.readings.peer_stats()[0].taken == 5).await;
}

#[tokio::test]
async fn what_was_received_of_one_pusher_is_told_while_messages_of_another_wait() {
    let folder = tempfile::tempdir().unwrap();
    let options = OpenOptions::new().runtime_dir(folder.path()).transport_kind(TransportKind::Ipc);
    let mut source = Source::open_with(options.clone()).await.unwrap();
    let mut other = Other::open_with(options.clone()).await.unwrap();
    let mut sink = Sink::open_with(options).await.unwrap();
    for (pusher, waiting) in [(&mut source.work, 3), (&mut other.work, 6)] {
        for number in 0..3 {
            pusher.send(&number).await.unwrap();
        }
        until(|| sink.work.stats().waiting == waiting).await;
    }
    source_has_asked(folder.path()).await;
    for number in 0..3 {
        assert_eq!(sink.work.try_recv().unwrap(), Some(number));
    }
    until(|| source.work.peer_stats()[0].taken == 3).await;
    assert_eq!(other.work.peer_stats()[0].waiting, 3);
}

/// Whenever a component writes its figures, it asks what was received.
async fn source_has_asked(folder: &Path) {
    let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.into());
    let dir = RuntimeDir::existing(&variable).unwrap().unwrap().existing_system("full-queue").unwrap().unwrap();
    let written = || ComponentStats::read(&dir, "source").unwrap().written;
    for _ in 0..2 {
        let before = written();
        until(|| written() > before).await;
    }
}

/// Lets the gates' tasks run until something holds.
async fn until(holds: impl Fn() -> bool) {
    let started = Instant::now();
    while !holds() {
        assert!(started.elapsed() < LONG, "does not happen");
        tokio::task::yield_now().await;
    }
}
