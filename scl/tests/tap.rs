//! The client of taps: everything is observed, across restarts, in bursts and at any length.
#![allow(clippy::unwrap_used)]

use crate::untyped::plan;
use bytes::Bytes;
use scl::runtime_dir::{RuntimeDir, SystemDir};
use scl::tap::{Observation, ObservedKind, Observer, TapEvent};
use scl::untyped::Component;
use scl::{OpenOptions, TransportKind};
use std::io::{Read, Write};
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::time::Duration;

const LONG: Duration = Duration::from_secs(300);

struct Stage {
    root: tempfile::TempDir,
    options: OpenOptions,
}

impl Stage {
    fn new(kind: TransportKind) -> Self {
        let root = tempfile::tempdir().unwrap();
        let options = OpenOptions::new().runtime_dir(root.path()).transport_kind(kind);
        Self { root, options }
    }

    fn dir(&self) -> SystemDir {
        RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| self.root.path().into()))
            .unwrap()
            .system("untyped")
            .unwrap()
    }

    async fn open(&self, component: &str) -> Component {
        Component::open_with(&plan(component), self.options.clone()).await.unwrap()
    }

    fn observe(&self, gate: &str) -> Observer {
        let (component, name) = gate.split_once('.').unwrap();
        let plan = plan(component);
        Observer::open(&self.dir(), plan.gate(name).unwrap().tap.as_deref().unwrap())
    }
}

fn on_each_transport<F: Future<Output = ()>>(test: impl Fn(Stage) -> F) {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let current = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        current.block_on(test(Stage::new(kind)));
    }
}

async fn next(observer: &mut Observer) -> TapEvent {
    tokio::time::timeout(LONG, observer.next()).await.expect("an event at the tap")
}

async fn observed(observer: &mut Observer) -> Observation {
    match next(observer).await {
        TapEvent::Observed(observation) => observation,
        other => panic!("{other:?}"),
    }
}

/// The promise: messages, requests and replies are observed with what belongs to them, in whatever order the programs
/// start.
#[test]
fn everything_at_a_gate_is_observed() {
    on_each_transport(async |stage| {
        let (mut raw_tap, mut work_tap, mut call_tap) =
            (stage.observe("sensor.raw"), stage.observe("controller.work"), stage.observe("sensor.calibrate"));
        let (mut sensor, mut controller) = (stage.open("sensor").await, stage.open("controller").await);
        sensor.ready(LONG).await.unwrap();
        for tap in [&mut raw_tap, &mut work_tap, &mut call_tap] {
            assert_eq!(next(tap).await, TapEvent::Connected);
        }
        let mut raw = sensor.publisher("raw").unwrap();
        let before = now_ns();
        for text in ["", "one", "two"] {
            raw.send(&Bytes::from(text)).await.unwrap();
        }
        let seen = [observed(&mut raw_tap).await, observed(&mut raw_tap).await, observed(&mut raw_tap).await];
        assert_eq!(seen.each_ref().map(|seen| &seen.payload[..]), [&b""[..], b"one", b"two"]);
        assert_eq!([seen[1].sequence, seen[2].sequence], [seen[0].sequence + 1, seen[0].sequence + 2]);
        for seen in &seen {
            assert!(before <= seen.sent_ns && seen.sent_ns <= seen.received_ns && seen.received_ns <= now_ns());
            assert_eq!((seen.kind, seen.call_id), (ObservedKind::Message, 0));
        }
        let (mut work, mut worker) = (sensor.pusher("work").unwrap(), controller.puller("work").unwrap());
        work.send(&Bytes::from_static(b"job")).await.unwrap();
        worker.recv().await.unwrap();
        assert_eq!(observed(&mut work_tap).await.payload, "job");
        let (mut asks, mut answers) =
            (controller.requester("calibrate").unwrap(), sensor.replier("calibrate").unwrap());
        let (request, reply) = (Bytes::from_static(b"?"), Bytes::from_static(b"!"));
        let answer = async { answers.recv().await.unwrap().reply(&reply).unwrap() };
        let (answered, ()) = tokio::join!(asks.call(&request), answer);
        assert_eq!(answered.unwrap(), reply);
        let seen = [observed(&mut call_tap).await, observed(&mut call_tap).await];
        assert_eq!(seen.each_ref().map(|seen| seen.kind), [ObservedKind::Request, ObservedKind::Reply]);
        assert_eq!(seen.each_ref().map(|seen| &seen.payload[..]), [b"?", b"!"]);
        assert_eq!(seen[0].call_id, seen[1].call_id);
        assert_eq!([&raw_tap, &work_tap, &call_tap].map(Observer::rejected), [0; 3]);
    });
}

/// The promise: an observer that joins a latched gate gets its last message first, and learns that it is old.
#[test]
fn an_observer_that_joins_a_latched_gate_gets_the_last_message() {
    on_each_transport(async |stage| {
        let mut plan = plan("sensor");
        plan.gates.iter_mut().find(|gate| gate.name == "raw").unwrap().options.latched = true;
        let mut sensor = Component::open_with(&plan, stage.options.clone()).await.unwrap();
        let mut raw = sensor.publisher("raw").unwrap();
        raw.send(&Bytes::from_static(b"one")).await.unwrap();
        for text in [&b"two"[..], b"three"] {
            raw.send(&Bytes::from_static(text)).await.unwrap();
            let mut tap = stage.observe("sensor.raw");
            assert_eq!(next(&mut tap).await, TapEvent::Connected);
            let seen = observed(&mut tap).await;
            assert_eq!((&seen.payload[..], seen.latched), (text, true));
            raw.send(&Bytes::from_static(b"new")).await.unwrap();
            let newer = observed(&mut tap).await;
            assert_eq!((&newer.payload[..], newer.latched, newer.sequence), (&b"new"[..], false, seen.sequence + 1));
        }
    });
}

/// The promise: an observer sees the component again after a restart, and says when it was gone.
#[test]
fn a_component_that_restarts_is_observed_again() {
    on_each_transport(async |stage| {
        let mut tap = stage.observe("sensor.raw");
        for _ in 0..3 {
            let mut sensor = stage.open("sensor").await;
            assert_eq!(next(&mut tap).await, TapEvent::Connected);
            let mut raw = sensor.publisher("raw").unwrap();
            raw.send(&Bytes::from_static(b"one")).await.unwrap();
            assert_eq!(observed(&mut tap).await.payload, "one");
            drop((raw, sensor));
            assert_eq!(next(&mut tap).await, TapEvent::Disconnected);
        }
    });
}

/// The promise: whatever is sent after `Connected` was seen is observed, however soon.
#[test]
fn everything_after_connected_is_observed() {
    on_each_transport(async |stage| {
        let plan = plan("sensor");
        let options = stage.options.clone();
        let (connected, connections) = std::sync::mpsc::channel::<u32>();
        // A thread of its own, so that it sends at any moment of what the component's runtime does.
        let sender = std::thread::spawn(move || {
            let mut sensor = Component::open_blocking_with(&plan, options).unwrap();
            let mut raw = sensor.publisher("raw").unwrap();
            // Spinning, not to lose the time of a wake-up.
            loop {
                match connections.try_recv() {
                    Ok(number) => raw.try_send(&Bytes::copy_from_slice(&number.to_le_bytes())).unwrap(),
                    Err(std::sync::mpsc::TryRecvError::Empty) => std::hint::spin_loop(),
                    Err(std::sync::mpsc::TryRecvError::Disconnected) => break,
                }
            }
        });
        for number in 0..500_u32 {
            let mut tap = stage.observe("sensor.raw");
            assert_eq!(next(&mut tap).await, TapEvent::Connected);
            connected.send(number).unwrap();
            assert_eq!(observed(&mut tap).await.payload, number.to_le_bytes()[..]);
        }
        drop(connected);
        sender.join().unwrap();
    });
}

/// The promise: a burst of some thousand messages is observed completely by an observer that is held up meanwhile, and
/// a message as long as they may be is, too.
#[test]
fn bursts_and_long_messages_are_observed_completely() {
    on_each_transport(async |stage| {
        const BURST: u64 = 5000;
        let mut tap = stage.observe("sensor.raw");
        let mut sensor = stage.open("sensor").await;
        assert_eq!(next(&mut tap).await, TapEvent::Connected);
        let mut raw = sensor.publisher("raw").unwrap();
        for number in 0..BURST {
            raw.try_send(&Bytes::copy_from_slice(&number.to_le_bytes())).unwrap();
        }
        let first = observed(&mut tap).await.sequence;
        for number in 1..BURST {
            let seen = observed(&mut tap).await;
            assert_eq!((seen.sequence, &seen.payload[..]), (first + number, &number.to_le_bytes()[..]));
        }
        let long = Bytes::from((0..64 << 20).map(|index: u32| (index >> 10) as u8).collect::<Vec<_>>());
        for _ in 0..2 {
            raw.try_send(&long).unwrap();
            assert!(observed(&mut tap).await.payload == long);
        }
    });
}

/// The promise: an observer can be dropped and polled anew at any time without losing a message.
#[test]
fn waiting_is_cancel_safe() {
    on_each_transport(async |stage| {
        let mut tap = stage.observe("sensor.raw");
        let mut sensor = stage.open("sensor").await;
        while tokio::time::timeout(Duration::from_micros(100), tap.next()).await != Ok(TapEvent::Connected) {}
        let mut raw = sensor.publisher("raw").unwrap();
        let mut last = None;
        for number in 0..1000_u32 {
            raw.send(&Bytes::copy_from_slice(&number.to_le_bytes())).await.unwrap();
            loop {
                // Polled once, and dropped.
                let polled = std::future::poll_fn(|cx| std::task::Poll::Ready(tap.poll_next(cx))).await;
                if let std::task::Poll::Ready(TapEvent::Observed(seen)) = polled {
                    assert!(last.is_none_or(|last| seen.sequence == last + 1), "{last:?} {seen:?}");
                    last = Some(seen.sequence);
                    break;
                }
                tokio::task::yield_now().await;
            }
        }
    });
}

/// The promise: a stranger in the place of a tap is no danger: what it says is counted or ends the connection.
#[tokio::test]
async fn nonsense_is_rejected_and_counted() {
    let stage = Stage::new(TransportKind::Ipc);
    let folder = stage.dir().folder().to_owned();
    let tap = plan("sensor").gate("raw").unwrap().tap.clone().unwrap();
    let meta = |kind: u8| [&[7; 24][..], &[kind, 0, 0, 0, 0, 0, 0, 0]].concat();
    let two =
        |payload: &[u8], meta: &[u8]| [&[1, payload.len() as u8][..], payload, &[0, meta.len() as u8], meta].concat();
    let good = two(b"good", &meta(2));
    let rejected =
        [two(b"x", &meta(3)), two(b"x", &[0; 31]), [0, 1, 9].to_vec(), [&[1, 1, 7][..], &two(b"x", &meta(0))].concat()];
    let fatal = [vec![0xff; 9], [&[3][..], &[0xff; 8]].concat(), vec![4, 2, 9, 9]];
    for last in fatal {
        let said = [rejected.concat(), good.clone(), last].concat();
        let server = serve(&folder.join(&tap), said);
        let mut observer = Observer::open(&stage.dir(), &tap);
        assert_eq!(next(&mut observer).await, TapEvent::Connected);
        let seen = observed(&mut observer).await;
        assert_eq!((&seen.payload[..], seen.kind), (&b"good"[..], ObservedKind::Reply));
        assert_eq!((seen.sequence, seen.call_id), (0x0707_0707_0707_0707, 0x0707_0707_0707_0707));
        assert_eq!(observer.rejected(), 4);
        assert_eq!(next(&mut observer).await, TapEvent::Disconnected);
        server.join().unwrap();
    }
}

/// Plays a tap once: handshake, then what is given.
fn serve(path: &Path, said: Vec<u8>) -> std::thread::JoinHandle<()> {
    let _gone = std::fs::remove_file(path);
    let listener = UnixListener::bind(path).unwrap();
    std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut greeting = [0; 64];
        greeting[0] = 0xff;
        greeting[9] = 0x7f;
        greeting[10] = 3;
        greeting[12..16].copy_from_slice(b"NULL");
        let ready = b"\x04\x1a\x05READY\x0bSocket-Type\0\0\0\x04XPUB";
        let ready = [&ready[..1], &[(ready.len() - 2) as u8], &ready[2..]].concat();
        stream.write_all(&greeting).unwrap();
        stream.write_all(&ready).unwrap();
        stream.write_all(&said).unwrap();
        let mut heard = [0; 1024];
        while !matches!(stream.read(&mut heard), Ok(0) | Err(_)) {}
    })
}

fn now_ns() -> u64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_nanos() as u64
}
