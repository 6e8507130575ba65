//! Queues of loans: who waits, what is dropped, and what the counts say.

use super::{Camera, Detector, Image, LONG, Viewer, on_each_transport, on_each_transport_async, send};
use scl::transport::memory::Memory;
use scl::{OpenOptions, PeerStats, SendTimeoutError, TrySendError};
use std::time::Duration;

fn assert_adds_up(stats: &PeerStats) {
    let PeerStats { published, taken, replaced, dropped_oldest, dropped_newest, lost, waiting, .. } = stats;
    assert_eq!(*published, taken + replaced + dropped_oldest + dropped_newest + lost + waiting, "{stats:?}");
}

#[tokio::test]
async fn what_waits_for_a_slow_reader_is_dropped_as_declared() {
    const SENT: u64 = 100;
    let options = OpenOptions::new().transport(Memory::new());
    let mut camera = Camera::open_with(options.clone()).await.unwrap();
    let mut detector = Detector::open_with(options).await.unwrap();
    camera.ready(LONG).await.unwrap();
    for number in 0..SENT {
        let mut bytes = camera.bytes.loan_bytes(8).unwrap();
        bytes.copy_from_slice(&number.to_be_bytes());
        // Without a turn for the detector: 64 are on their way, and 3 wait.
        bytes.try_send().unwrap();
    }
    let stats = camera.bytes.peer_stats().remove(0);
    assert_adds_up(&stats);
    assert_eq!((stats.published, stats.waiting, stats.dropped_oldest), (SENT, 64 + 3, SENT - 64 - 3));
    let number = |bytes: scl::bytes::Bytes| u64::from_be_bytes(bytes[..].try_into().unwrap());
    let mut received = Vec::new();
    while received.last() != Some(&(SENT - 1)) {
        received.push(number(detector.bytes.recv().await.unwrap()));
    }
    assert!(received.is_sorted(), "{received:?}");
    let dropped_by_detector = detector.bytes.stats().dropped_oldest;
    assert_eq!(received.len() as u64 + dropped_by_detector, 64 + 3);
    assert_adds_up(&camera.bytes.peer_stats()[0]);
}

#[test]
fn loans_wait_for_a_reader_that_makes_its_sender_wait() {
    on_each_transport_async(async |options| {
        let mut camera = Camera::open_with(options.clone()).await.unwrap();
        // The detector is required, so its queue of two makes the camera wait before it is there.
        for number in 0..2 {
            send(&mut camera, number).await;
        }
        let mut image = camera.images.loan().unwrap();
        image.fill(2);
        let Err(TrySendError::Full { .. }) = image.try_send() else { panic!("sent into a full queue") };
        {
            let mut image = camera.images.loan().unwrap();
            image.fill(2);
            let mut sends = Box::pin(image.send());
            let waits = tokio::time::timeout(Duration::from_millis(1), &mut sends).await;
            assert!(waits.is_err(), "sent into a full queue");
            // Dropped while it waits, it is sent to nobody.
        }
        let mut image = camera.images.loan().unwrap();
        image.fill(3);
        let detect = async {
            let mut detector = Detector::open_with(options).await.unwrap();
            for expected in [0, 1, 3] {
                assert_eq!(detector.images.recv_view().await.unwrap().number(), expected);
            }
            detector
        };
        let (sent, _detector) = tokio::join!(image.send(), detect);
        sent.unwrap();
        camera.ready(LONG).await.unwrap();
        camera.close(LONG).await.unwrap();
    });
}

#[test]
fn a_time_limit_ends_the_wait_and_the_message() {
    on_each_transport(|options| {
        let mut camera = Camera::open_blocking_with(options.clone()).unwrap();
        for number in 0..2 {
            let mut image = camera.images.loan().unwrap();
            image.fill(number);
            image.send_blocking().unwrap();
        }
        let image = camera.images.loan().unwrap();
        let Err(SendTimeoutError::Timeout { .. }) = image.send_timeout(Duration::ZERO) else {
            panic!("sent into a full queue")
        };
        assert_eq!(camera.images.peer_stats()[0].published, 2);
    });
}

/// 64 messages are on their way to the detector, and the loans behind them wait in the camera.
#[tokio::test]
async fn loans_that_wait_in_a_queue_reach_the_next_connection() {
    let options = OpenOptions::new().transport(Memory::new());
    let mut camera = Camera::open_with(options.clone()).await.unwrap();
    let detector = Detector::open_with(options.clone()).await.unwrap();
    camera.ready(LONG).await.unwrap();
    let mut lent_at = Vec::new();
    for number in 0..64 + 3 {
        let mut bytes = camera.bytes.loan_bytes(100_000).unwrap();
        bytes.fill(number);
        lent_at.push(bytes.as_ptr());
        bytes.try_send().unwrap();
    }
    drop(detector);
    let mut detector = Detector::open_with(options).await.unwrap();
    for number in 64..64 + 3 {
        let bytes = detector.bytes.recv().await.unwrap();
        assert!(bytes.iter().all(|&byte| byte == number), "expected {number}, received {}", bytes[0]);
        assert_ne!(bytes.as_ptr(), lent_at[usize::from(number)], "memory of a connection that is gone");
    }
    let stats = camera.bytes.peer_stats().remove(0);
    assert_adds_up(&stats);
    assert_eq!((stats.published, stats.lost), (67, 64));
}

#[test]
fn loans_are_handed_over_when_their_gate_is_dropped() {
    on_each_transport_async(async |options| {
        let mut camera = Camera::open_with(options.clone()).await.unwrap();
        let mut viewer = Viewer::open_with(options.clone()).await.unwrap();
        let mut detector = Detector::open_with(options).await.unwrap();
        camera.ready(LONG).await.unwrap();
        viewer.ready(LONG).await.unwrap();
        for number in 0..3 {
            send(&mut camera, number).await;
        }
        let receive = async |images: &mut scl::Sub<Image>| {
            for expected in 0..3 {
                assert_eq!(images.recv_view().await.unwrap().number(), expected);
            }
        };
        let (closed, (), ()) =
            tokio::join!(camera.close(LONG), receive(&mut detector.images), receive(&mut viewer.images));
        closed.unwrap();
    });
}

/// The gate's own hand-over may be done first, and its end is gone then.
#[tokio::test(start_paused = true)]
async fn closing_ends_as_soon_as_everything_is_taken() {
    let options = OpenOptions::new().transport(Memory::new());
    let mut camera = Camera::open_with(options.clone()).await.unwrap();
    let mut detector = Detector::open_with(options).await.unwrap();
    camera.ready(LONG).await.unwrap();
    send(&mut camera, 1).await;
    let started = tokio::time::Instant::now();
    let (closed, received) = tokio::join!(camera.close(LONG), detector.images.recv_view());
    closed.unwrap();
    assert_eq!(received.unwrap().number(), 1);
    // The clock stands still while anything can happen.
    assert_eq!(started.elapsed(), Duration::ZERO);
}
