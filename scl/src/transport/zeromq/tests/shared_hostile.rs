//! Peers that lie about shared memory.

use super::shared::{LONG, both, endpoint, hello_saying, until_shared};
use super::stage::{ENDPOINT, Outgoing, Stage, next, pattern};
use crate::transport::Transport;
use crate::transport::zeromq::TransportKind;
use crate::transport::zeromq::memory_format::memory_format;
use crate::transport::zeromq::zmtp::sample;
use scl_shm::{SampleSender, ServiceName, SharedMemory};
use std::future::poll_fn;
use std::task::Poll;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::UnixStream;

/// A pusher that says what a test wants.
struct Liar {
    stream: UnixStream,
    service: ServiceName,
    receiver: Box<dyn crate::transport::Receiver>,
}

impl Liar {
    /// Connects to a puller, and agrees with it on shared memory.
    async fn connect(stage: &Stage) -> Self {
        let mut receiver = stage.transport.pull(&endpoint()).unwrap();
        let mut stream = stage.connect_silently().await;
        let words = format!("1 shm={}", memory_format().unwrap());
        stream.write_all(&pusher_hello(words.as_bytes())).await.unwrap();
        let mut heard = Vec::new();
        let opened = b"X-SCL-SHM-OPEN";
        poll_fn(|cx| {
            assert!(receiver.poll_recv(cx).is_pending());
            let mut buffer = [0; 1024];
            match stream.try_read(&mut buffer) {
                Ok(read) => heard.extend_from_slice(&buffer[..read]),
                Err(_nothing_yet) => {}
            }
            cx.waker().wake_by_ref();
            if heard.windows(opened.len()).any(|window| window == opened) { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        let text = String::from_utf8_lossy(&heard).into_owned();
        let service = text.split(&format!("shm={},", memory_format().unwrap())).nth(1).unwrap()[..32].to_owned();
        Self { stream, service: ServiceName(u128::from_str_radix(&service, 16).unwrap()), receiver }
    }

    fn sender(&self, stage: &Stage) -> SampleSender {
        SharedMemory::open(stage.dir.folder()).unwrap().sender(self.service, 1).unwrap()
    }

    /// The puller closes the connection, and then serves a good pusher.
    async fn expect_closed(mut self, stage: &Stage, case: &str) {
        poll_fn(|cx| {
            assert!(self.receiver.poll_recv(cx).is_pending(), "{case}: received what was not sent");
            if self.receiver.peers() == 0 { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        assert_eq!(
            self.stream.read_to_end(&mut Vec::new()).await.map(drop).map_err(|error| error.kind()),
            Ok(()),
            "{case}"
        );
        let mut good = Outgoing::new(stage.transport.push(&endpoint()).unwrap());
        until_shared(&mut good, &mut *self.receiver).await;
        good.queue([pattern(LONG)]);
        assert!(good.during(next(&mut *self.receiver)).await == pattern(LONG), "{case}");
    }
}

fn pusher_hello(words: &[u8]) -> Vec<u8> {
    hello_of(*b"\x04PUSH", words)
}

/// The same as a subscriber's hello, for another type of socket.
fn hello_of(socket: [u8; 5], words: &[u8]) -> Vec<u8> {
    let mut hello = hello_saying(words);
    let place = hello.windows(4).position(|window| window == b"\x03SUB").unwrap();
    hello.splice(place..place + 4, socket);
    hello[65] += 1;
    hello
}

#[tokio::test]
async fn announcements_that_do_not_fit_end_the_connection() {
    type Case = (&'static str, fn(&mut SampleSender) -> Vec<u8>);
    let cases: [Case; 7] = [
        ("nothing was sent", |_| sample(1, 100).to_vec()),
        ("too long", |sender| {
            send(sender, 100);
            sample(1, 101).to_vec()
        }),
        ("too short", |sender| {
            send(sender, 100);
            sample(1, 99).to_vec()
        }),
        ("longer than anything", |sender| {
            send(sender, 100);
            sample(1, u64::MAX).to_vec()
        }),
        ("not the first", |sender| {
            send(sender, 100);
            sample(2, 100).to_vec()
        }),
        ("number zero", |sender| {
            send(sender, 100);
            sample(0, 100).to_vec()
        }),
        ("without a length", |sender| {
            send(sender, 100);
            [&[4, 21], &sample(1, 100)[2..23]].concat()
        }),
    ];
    for (case, lie) in cases {
        let stage = Stage::new(TransportKind::Shm);
        let mut liar = Liar::connect(&stage).await;
        let mut sender = liar.sender(&stage);
        let command = lie(&mut sender);
        liar.stream.write_all(&command).await.unwrap();
        liar.expect_closed(&stage, case).await;
    }
}

fn send(sender: &mut SampleSender, length: usize) {
    let sample = sender.copy(&pattern(length)).unwrap();
    sender.send(sample).unwrap();
}

#[tokio::test]
async fn more_announcements_than_samples_end_the_connection() {
    let stage = Stage::new(TransportKind::Shm);
    let mut liar = Liar::connect(&stage).await;
    let mut sender = liar.sender(&stage);
    for _ in 0..4 {
        send(&mut sender, 100);
    }
    let beyond = sender.copy(b"beyond the credit").unwrap();
    sender.send(beyond).unwrap_err();
    let announced: Vec<u8> = (1..=5).flat_map(|sequence| sample(sequence, 100)).collect();
    liar.stream.write_all(&announced).await.unwrap();
    for _ in 0..4 {
        assert!(next(&mut *liar.receiver).await == pattern(100));
    }
    liar.expect_closed(&stage, "the fifth").await;
}

#[tokio::test]
async fn samples_without_shared_memory_end_the_connection() {
    for kind in [TransportKind::Ipc, TransportKind::Shm] {
        let stage = Stage::new(kind);
        let mut receiver = stage.transport.pull(&endpoint()).unwrap();
        let mut stream = stage.connect_silently().await;
        stream.write_all(&[&pusher_hello(b"1")[..], &sample(1, 100)].concat()).await.unwrap();
        let mut buffer = Vec::new();
        let closed = async { stream.read_to_end(&mut buffer).await };
        let mut closed = std::pin::pin!(closed);
        poll_fn(|cx| {
            assert!(receiver.poll_recv(cx).is_pending());
            closed.as_mut().poll(cx)
        })
        .await
        .unwrap();
    }
}

#[tokio::test]
async fn services_that_do_not_exist_leave_the_connection_to_the_socket() {
    // A puller that offers a service and claims to have opened it.
    let stage = Stage::new(TransportKind::Shm);
    let listener = crate::runtime_dir::bind_ipc(&stage.dir, ENDPOINT).unwrap();
    listener.listener.set_nonblocking(true).unwrap();
    let puller = tokio::net::UnixListener::from_std(listener.listener).unwrap();
    let mut pusher = Outgoing::new(stage.transport.push(&endpoint()).unwrap());
    let words = format!("1 window=100,1000000 shm={},{}", memory_format().unwrap(), ServiceName::unique());
    let mut stream = pusher.during(puller.accept()).await.unwrap().0;
    let hello = hello_of(*b"\x04PULL", words.as_bytes());
    stream.write_all(&[&hello[..], b"\x04\x0f\x0eX-SCL-SHM-OPEN"].concat()).await.unwrap();
    pusher.until(|pusher| !pusher.peers.is_empty()).await;
    pusher.queue([pattern(LONG)]);
    let mut heard = Vec::new();
    pusher
        .during(async {
            while !heard.ends_with(&pattern(LONG)) {
                assert!(stream.read_buf(&mut heard).await.unwrap() > 0);
            }
        })
        .await;
    assert!(pusher.link().loan(LONG).is_none());
}

#[tokio::test]
async fn a_malformed_service_name_ends_the_connection() {
    let stage = Stage::new(TransportKind::Shm);
    for name in ["", "x", "../../etc", "0123456789ABCDEF0123456789ABCDEF"] {
        let mut publisher = Outgoing::new(stage.transport.publish(&endpoint()).unwrap());
        let mut stream = stage.connect_silently().await;
        let words = format!("1 shm={},{name}", memory_format().unwrap());
        stream.write_all(&hello_saying(words.as_bytes())).await.unwrap();
        publisher.during(async { stream.read_to_end(&mut Vec::new()).await }).await.unwrap();
        assert!(publisher.peers.is_empty());
    }
}

#[tokio::test]
async fn a_receiver_that_leaves_loses_what_it_did_not_acknowledge() {
    let stage = Stage::new(TransportKind::Shm);
    for (mut sender, mut receiver) in both(&stage, &endpoint()) {
        until_shared(&mut sender, &mut *receiver).await;
        sender.queue((0..3).map(|_| pattern(LONG)));
        sender.until(|sender| sender.link().unacknowledged() == 3).await;
        drop(receiver);
        assert_eq!(sender.link().unacknowledged(), 3, "three are lost");
        sender.until(|sender| sender.peers.is_empty()).await;
    }
}
