//! The newest message of several senders that are busy between their calls, so that each answers late, and at another
//! time than the others.
#![allow(clippy::unwrap_used)]

use super::untyped::on_each_transport_async;
use futures_core::Stream;
use scl::Pub;
use std::future::poll_fn;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::Poll;
use std::thread::{self, JoinHandle};
use std::time::Duration;

scl::topology!("slow_senders.yaml");

/// How many messages must be received. A receiver that waits for a moment at which all senders have just answered gets
/// only a few.
const ENOUGH: u32 = 200;
const LONG: Duration = Duration::from_secs(300);

#[test]
fn a_call_has_the_newest_of_senders_that_are_slow_to_answer() {
    receive(async |fusion: &mut Fusion| fusion.values.recv().await.unwrap());
}

#[test]
fn a_call_that_is_given_up_again_and_again_has_the_newest_of_slow_senders() {
    receive(async |fusion: &mut Fusion| {
        loop {
            if let Poll::Ready(received) = poll_once(pin!(fusion.values.recv())).await {
                return received.unwrap();
            }
            tokio::task::yield_now().await;
        }
    });
}

#[test]
fn a_stream_has_the_newest_of_slow_senders() {
    receive(async |fusion: &mut Fusion| {
        poll_fn(|cx| Pin::new(&mut fusion.values).poll_next(cx)).await.unwrap().unwrap()
    });
}

#[test]
fn what_senders_answered_to_a_call_that_was_given_up_does_not_count_for_a_later_one() {
    on_each_transport_async(async |options| {
        let mut left = Left::open_with(options.clone()).await.unwrap();
        let right = Right::open_with(options.clone()).await.unwrap();
        let mut fusion = Fusion::open_with(options).await.unwrap();
        left.ready(LONG).await.unwrap();
        right.ready(LONG).await.unwrap();
        fusion.ready(LONG).await.unwrap();
        for round in 0..20 {
            // More than fits into a connection: the rest is held back.
            for number in 0..1000 {
                left.values.try_send(&(round * 10_000 + number)).unwrap();
            }
            assert!(poll_once(pin!(fusion.values.recv())).await.is_pending());
            for _ in 0..100 {
                tokio::task::yield_now().await;
            }
            for number in 1000..2000 {
                left.values.try_send(&(round * 10_000 + number)).unwrap();
            }
            // A stream is content with an answer of the last millisecond.
            thread::sleep(Duration::from_millis(2));
            let received = match round % 2 {
                0 => fusion.values.recv().await,
                _ => poll_fn(|cx| Pin::new(&mut fusion.values).poll_next(cx)).await.unwrap(),
            };
            assert_eq!(received.unwrap(), round * 10_000 + 1999);
        }
    });
}

async fn poll_once<F: Future>(mut call: Pin<&mut F>) -> Poll<F::Output> {
    poll_fn(|cx| Poll::Ready(call.as_mut().poll(cx))).await
}

/// Receives enough messages with `next`, over each transport.
fn receive(next: impl AsyncFn(&mut Fusion) -> u32) {
    on_each_transport_async(async |options| {
        let stop = Arc::new(AtomicBool::new(false));
        let (of_left, of_right) = (options.clone(), options.clone());
        let senders = [
            send_and_compute(5, &stop, async || Left::open_with(of_left).await.unwrap().values),
            send_and_compute(7, &stop, async || Right::open_with(of_right).await.unwrap().values),
        ];
        let mut fusion = Fusion::open_with(options).await.unwrap();
        fusion.ready(LONG).await.unwrap();
        for _ in 0..ENOUGH {
            next(&mut fusion).await;
        }
        stop.store(true, Ordering::SeqCst);
        for sender in senders {
            sender.join().unwrap();
        }
    });
}

/// Sends from a thread of its own. Between two messages the thread is busy, and its runtime cannot answer.
fn send_and_compute(
    milliseconds: u64,
    stop: &Arc<AtomicBool>,
    open: impl AsyncFnOnce() -> Pub<u32> + Send + 'static,
) -> JoinHandle<()> {
    let stop = Arc::clone(stop);
    thread::spawn(move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let mut values = open().await;
            for number in 0.. {
                if stop.load(Ordering::SeqCst) {
                    return;
                }
                values.send(&number).await.unwrap();
                tokio::task::yield_now().await;
                thread::sleep(Duration::from_millis(milliseconds));
            }
        });
    })
}
