//! How often a connecting end tries, counted on a clock that stands still.

use super::stage::{ENDPOINT, Stage, endpoint};
use crate::runtime_dir::FolderWatch;
use crate::transport::zeromq::TransportKind;
use crate::transport::{Endpoint, Receiver, Transport};
use rustix::net::{AddressFamily, SocketAddrUnix, SocketType, bind, listen, socket};
use std::future::poll_fn;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::task::Poll;
use std::time::Duration;

const TRANSPORTS: [TransportKind; 2] = [TransportKind::Ipc, TransportKind::Tcp];

/// A subscriber whose publisher has been killed: its socket's file is still there.
struct Lonely {
    stage: Stage,
    subscriber: Box<dyn Receiver>,
    attempts: Arc<AtomicU32>,
}

impl Lonely {
    fn new(kind: TransportKind) -> Self {
        let stage = Stage::new(kind);
        let file = stage.dir.folder().join(match kind {
            TransportKind::Tcp => format!("{ENDPOINT}.tcp"),
            _ => ENDPOINT.to_owned(),
        });
        let kept = file.with_file_name("kept");
        let publisher = stage.publisher();
        std::fs::rename(&file, &kept).unwrap();
        drop(publisher);
        std::fs::rename(&kept, &file).unwrap();
        Self::subscribe(stage)
    }

    fn subscribe(stage: Stage) -> Self {
        let attempts = Arc::new(AtomicU32::new(0));
        let counted = Arc::clone(&attempts);
        let check = move || {
            counted.fetch_add(1, Ordering::SeqCst);
            Ok(())
        };
        let endpoint = Endpoint { check: Some(Arc::new(check)), ..endpoint() };
        let subscriber = stage.transport.subscribe(&endpoint).unwrap();
        Self { stage, subscriber, attempts }
    }

    /// The number of attempts within a time.
    async fn attempts(&mut self, within: Duration) -> u32 {
        let before = self.attempts.load(Ordering::SeqCst);
        let subscriber = &mut self.subscriber;
        let driven = poll_fn(|cx| {
            assert!(subscriber.poll_recv(cx).is_pending());
            Poll::<()>::Pending
        });
        assert!(tokio::time::timeout(within, driven).await.is_err());
        self.attempts.load(Ordering::SeqCst) - before
    }
}

#[tokio::test(start_paused = true)]
async fn a_peer_that_stays_away_is_tried_rarely_until_a_file_arrives() {
    for kind in TRANSPORTS {
        let mut lonely = Lonely::new(kind);
        lonely.stage.dir.count_watch(true);
        // Twice at the quick pace: what arrived before the watch began is not known.
        let first = lonely.attempts(Duration::from_secs(2)).await;
        assert!((24..=60).contains(&first), "{kind:?}: {first}");
        let later = lonely.attempts(Duration::from_secs(60)).await;
        assert!((100..=120).contains(&later), "{kind:?}: {later}");
        lonely.stage.dir.mark_arrived();
        let at_once = lonely.attempts(Duration::from_millis(1)).await;
        assert_eq!(at_once, 1, "{kind:?}");
        let after = lonely.attempts(Duration::from_millis(400)).await;
        assert!((15..=20).contains(&after), "{kind:?}: {after}");
    }
}

/// It is alive, so each of its accepts may be the one that counts.
#[tokio::test(start_paused = true)]
async fn a_peer_that_has_no_room_for_connections_does_not_stay_away() {
    let stage = Stage::new(TransportKind::Ipc);
    let path = stage.dir.folder().join(ENDPOINT);
    let listener = socket(AddressFamily::UNIX, SocketType::STREAM, None).unwrap();
    bind(&listener, &SocketAddrUnix::new(&path).unwrap()).unwrap();
    listen(&listener, 0).unwrap();
    let _first = UnixStream::connect(&path).unwrap();
    let mut lonely = Lonely::subscribe(stage);
    lonely.stage.dir.count_watch(true);
    let attempts = lonely.attempts(Duration::from_secs(20)).await;
    assert!((800..=1000).contains(&attempts), "{attempts}");
}

#[tokio::test(start_paused = true)]
async fn without_a_watch_of_the_folder_the_pace_stays() {
    for kind in TRANSPORTS {
        let mut lonely = Lonely::new(kind);
        let attempts = lonely.attempts(Duration::from_secs(20)).await;
        assert!((800..=1000).contains(&attempts), "{kind:?}: {attempts}");
    }
}

/// Renamed into the folder by SCL, or created there by a plain ZeroMQ program.
#[tokio::test]
async fn files_that_arrive_are_reported_while_the_folder_is_watched() {
    let stage = Stage::new(TransportKind::Ipc);
    let dir = &stage.dir;
    assert!(!dir.reports_arrivals());
    let _lock = crate::runtime_dir::ComponentLock::take(dir, "controller").unwrap();
    let watch = FolderWatch::start(dir, "controller", None).unwrap();
    assert!(dir.reports_arrivals());
    let mut seen = crate::runtime_dir::Seen::default();
    let mut arrive = async |put: &dyn Fn()| {
        poll_fn(|cx| {
            while dir.poll_arrived(&mut seen, cx).is_ready() {}
            Poll::Ready(())
        })
        .await;
        put();
        tokio::select! {
            _ = watch.removal() => panic!("nothing was removed"),
            () = poll_fn(|cx| dir.poll_arrived(&mut seen, cx)) => {}
        }
    };
    let publisher = std::cell::RefCell::new(None);
    arrive(&|| *publisher.borrow_mut() = Some(stage.publisher())).await;
    arrive(&|| std::fs::write(dir.folder().join("sensor.plain"), "").unwrap()).await;
    drop(watch);
    assert!(!dir.reports_arrivals());
}
