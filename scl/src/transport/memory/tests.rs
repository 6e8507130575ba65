//! What the conformance suite does not ask of every transport.

use super::Memory;
use super::pipe::pipe;
use crate::transport::{Endpoint, Link, Peer, Requester, Sender, Sent, Transport};
use bytes::Bytes;
use std::collections::VecDeque;
use std::convert::identity;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll, Wake, Waker};

const NAME: &str = "a.out--b.in.1a2b3c4d";

#[test]
fn a_second_listener_is_refused_until_the_first_is_dropped() {
    let memory = Memory::new();
    let first = memory.publish(&Endpoint::new(NAME)).unwrap();
    let error = memory.publish(&Endpoint::new(NAME)).map(drop).unwrap_err().to_string();
    assert!(error.contains(NAME) && error.contains("already listening"), "{error}");
    let _other_memory = Memory::new().publish(&Endpoint::new(NAME)).unwrap();
    drop(first);
    memory.publish(&Endpoint::new(NAME)).unwrap();
}

#[test]
fn a_subscriber_that_was_dropped_is_not_returned() {
    let memory = Memory::new();
    let mut publisher = memory.publish(&Endpoint::new(NAME)).unwrap();
    drop(memory.subscribe(&Endpoint::new(NAME)).unwrap());
    assert!(publisher.poll_peer(&mut no_waker()).is_pending());
}

#[test]
fn a_subscriber_that_was_replaced_stays_unconnected_until_a_new_publisher_listens() {
    let memory = Memory::new();
    let mut subscriber = memory.subscribe(&Endpoint::new(NAME)).unwrap();
    let mut publisher = memory.publish(&Endpoint::new(NAME)).unwrap();
    drop(link(&mut *publisher));
    assert!(subscriber.poll_recv(&mut no_waker()).is_pending());
    assert!(publisher.poll_peer(&mut no_waker()).is_pending(), "connected again");
    drop(publisher);
    let mut publisher = memory.publish(&Endpoint::new(NAME)).unwrap();
    let sent = link(&mut *publisher).send(&mut no_waker(), Bytes::from_static(b"back").into());
    assert!(matches!(sent, Sent::Sent));
    assert_eq!(subscriber.poll_recv(&mut no_waker()), Poll::Ready(Bytes::from_static(b"back")));
}

#[test]
fn what_a_dropped_reader_leaves_behind_stays_unacknowledged() {
    let memory = Memory::new();
    let mut publisher = memory.publish(&Endpoint::new(NAME)).unwrap();
    let mut subscriber = memory.subscribe(&Endpoint::new(NAME)).unwrap();
    let mut link = link(&mut *publisher);
    for _ in 0..3 {
        assert!(matches!(link.send(&mut no_waker(), Bytes::new().into()), Sent::Sent));
    }
    assert!(subscriber.poll_recv(&mut no_waker()).is_ready());
    drop(subscriber);
    assert!(link.drive(&mut no_waker()).is_err());
    assert_eq!(link.unacknowledged(), 2);
}

#[test]
fn a_connection_holds_64_messages_or_one_if_only_the_newest_counts() {
    let memory = Memory::new();
    for newest_only in [false, true] {
        let receiving = Endpoint { newest_only, ..Endpoint::new(NAME) };
        let sending = Endpoint { newest_only: !newest_only, ..Endpoint::new(NAME) };
        let mut publisher = memory.publish(&sending).unwrap();
        let _subscriber = memory.subscribe(&receiving).unwrap();
        let mut pusher = memory.push(&sending).unwrap();
        let _puller = memory.pull(&receiving).unwrap();
        for mut link in [link(&mut *publisher), link(&mut *pusher)] {
            let sent =
                (0..1000).take_while(|_| link.send(&mut no_waker(), Bytes::new().into()).returned().is_none()).count();
            assert_eq!(sent, if newest_only { 1 } else { 64 });
        }
    }
}

#[test]
fn a_requester_waits_until_the_replier_has_room() {
    let memory = Memory::new();
    let mut requester = memory.request(&Endpoint::new(NAME)).unwrap();
    let mut replier = memory.reply(&Endpoint::new(NAME)).unwrap();
    let (wakes, waker) = counting_waker();
    let mut cx = Context::from_waker(&waker);
    let ask = |requester: &mut dyn Requester, cx: &mut Context<'_>| requester.request(cx, 1, Bytes::new());
    assert!(requester.poll_connected(&mut cx).is_ready());
    let sent = (0..1000).take_while(|_| ask(&mut *requester, &mut cx).is_ok()).count();
    assert!(requester.poll_connected(&mut cx).is_pending());
    let before = wakes.count();
    let taken = (0..1000).take_while(|_| replier.poll_request(&mut no_waker()).is_ready()).count();
    assert_eq!((sent, taken, wakes.count()), (64, 64, before + 1));
    assert!(requester.poll_connected(&mut cx).is_ready());
}

#[test]
fn ends_count_peers_before_they_are_polled() {
    let memory = Memory::new();
    let replier = memory.reply(&Endpoint::new(NAME)).unwrap();
    let requester = memory.request(&Endpoint::new(NAME)).unwrap();
    assert!(requester.is_connected() && replier.peers() == 1);
    let puller = memory.pull(&Endpoint::new(NAME)).unwrap();
    let _pusher = memory.push(&Endpoint::new(NAME)).unwrap();
    assert_eq!(puller.peers(), 1);
    let subscriber = memory.subscribe(&Endpoint::new(NAME)).unwrap();
    let publisher = memory.publish(&Endpoint::new(NAME)).unwrap();
    assert_eq!(subscriber.peers(), 1);
    drop((requester, publisher));
    assert_eq!((replier.peers(), subscriber.peers()), (0, 0));
}

#[test]
fn a_refusal_is_over_when_nobody_listens_any_more() {
    let memory = Memory::new();
    let refuse = Arc::new(|| Err("another shape".to_owned()));
    let mut subscriber = memory.subscribe(&Endpoint { check: Some(refuse), ..Endpoint::new(NAME) }).unwrap();
    let publisher = memory.publish(&Endpoint::new(NAME)).unwrap();
    assert!(subscriber.poll_recv(&mut no_waker()).is_pending());
    assert_eq!(subscriber.refusal().as_deref(), Some("another shape"));
    drop(publisher);
    assert_eq!(subscriber.refusal(), None);
}

#[test]
fn a_refused_writer_is_woken_once_when_half_of_the_pipe_is_free() {
    let (writer, reader) = pipe(4);
    let (wakes, waker) = counting_waker();
    let cx = Context::from_waker(&waker);
    let mut items: VecDeque<i32> = (0..6).collect();
    writer.send_all(&cx, &mut items, identity, |_| {});
    assert_eq!(items, [4, 5]);
    let woken = [0; 4].map(|_| {
        assert!(reader.poll_recv(&no_waker()).is_ready());
        assert!(writer.poll_open(&cx));
        wakes.count()
    });
    assert_eq!(woken, [0, 1, 1, 1]);
}

#[test]
fn a_writer_is_woken_when_everything_is_taken_if_it_asked() {
    let (writer, reader) = pipe(4);
    let (wakes, waker) = counting_waker();
    let cx = Context::from_waker(&waker);
    for asks in [false, true] {
        writer.send(&cx, 1, None).unwrap();
        writer.send(&cx, 2, None).unwrap();
        let before = wakes.count();
        if asks {
            writer.wake_when_empty(&cx);
        }
        assert!(reader.poll_recv(&no_waker()).is_ready());
        assert_eq!(wakes.count(), before, "one is left");
        assert!(reader.poll_recv(&no_waker()).is_ready());
        assert_eq!(wakes.count(), before + usize::from(asks), "asked: {asks}");
    }
}

#[test]
fn sending_to_a_reader_that_is_gone_wakes_the_task() {
    let (writer, reader) = pipe(4);
    drop(reader);
    let (wakes, waker) = counting_waker();
    let cx = Context::from_waker(&waker);
    assert_eq!(writer.send(&cx, 1, None), Err(1));
    assert_eq!(wakes.count(), 1);
    writer.send_all(&cx, &mut VecDeque::from([1]), identity, |_| panic!("sent"));
    assert_eq!(wakes.count(), 2);
}

#[test]
fn an_answer_wakes_the_task_that_asked() {
    let (writer, reader) = pipe(1);
    let (wakes, waker) = counting_waker();
    let mut items = VecDeque::from([1, 2]);
    writer.send_all(&no_waker(), &mut items, identity, |_| {});
    assert_eq!(reader.poll_recv(&no_waker()), Poll::Ready(Some(1)));
    assert!(!reader.poll_caught_up(&Context::from_waker(&waker)));
    items.clear();
    writer.send_all(&no_waker(), &mut items, identity, |_| {});
    assert_eq!(wakes.count(), 1, "answered without a message");
    assert!(reader.poll_caught_up(&no_waker()));
}

fn link(sender: &mut dyn Sender) -> Box<dyn Link> {
    match sender.poll_peer(&mut no_waker()) {
        Poll::Ready(Peer { link, .. }) => link,
        Poll::Pending => panic!("no peer"),
    }
}

fn no_waker() -> Context<'static> {
    Context::from_waker(Waker::noop())
}

#[derive(Default)]
struct Wakes(AtomicUsize);

impl Wakes {
    fn count(&self) -> usize {
        self.0.load(Ordering::SeqCst)
    }
}

impl Wake for Wakes {
    fn wake(self: Arc<Self>) {
        self.0.fetch_add(1, Ordering::SeqCst);
    }
}

fn counting_waker() -> (Arc<Wakes>, Waker) {
    let wakes = Arc::new(Wakes::default());
    (Arc::clone(&wakes), wakes.into())
}
