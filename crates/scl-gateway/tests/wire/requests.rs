//! Requests and replies.

use bytes::Bytes;
use scl_gateway::wire::{ReplierEvent, RequesterEvent, Wire, WireReplier, WireRequester};

use super::network::*;
use super::proxy::{Proxy, Weather};

async fn both_ends(board: &Wire, ground: &Wire) -> (WireRequester, WireReplier) {
    let route = requests("board", "ground", "mode");
    let (mut requester, mut replier) = (board.requester(&route), ground.replier(&route));
    assert_eq!(replied(&mut replier).await, ReplierEvent::Matched);
    replier.set_open(true);
    assert_eq!(requested(&mut requester).await, RequesterEvent::Matched);
    (requester, replier)
}

async fn request(replier: &mut WireReplier) -> (u64, Bytes) {
    match replied(replier).await {
        ReplierEvent::Request { id, body } => (id, body),
        event => panic!("{event:?}"),
    }
}

/// A request and its reply.
pub(super) async fn one_request(board: &Wire, ground: &Wire) {
    let (mut requester, mut replier) = both_ends(board, ground).await;
    requester.request(1, Bytes::from_static(b"one"));
    let (id, body) = tokio::select! {
        request = request(&mut replier) => request,
        event = requested(&mut requester) => panic!("{event:?}"),
    };
    replier.reply(id, body);
    let event = tokio::select! {
        event = requested(&mut requester) => event,
        event = replied(&mut replier) => panic!("{event:?}"),
    };
    assert_eq!(event, RequesterEvent::Reply { id: 1, body: Bytes::from_static(b"one") });
}

#[tokio::test]
async fn replies_reach_their_requests_in_any_order() {
    let (board, ground) = two_hosts().await;
    let (mut requester, mut replier) = both_ends(&board, &ground).await;
    let large = Bytes::from(vec![3; 1 << 20]);
    for (id, body) in [(10, Bytes::from_static(b"ten")), (11, large.clone()), (12, Bytes::new())] {
        requester.request(id, body);
    }
    // The requester's task also resends, so both ends have to be driven.
    let (requests, _) = tokio::join!(
        async { [request(&mut replier).await, request(&mut replier).await, request(&mut replier).await] },
        async { assert_nothing_yet(&mut requester).await }
    );
    for (id, body) in requests.into_iter().rev() {
        match &*body {
            b"" => replier.give_up(id),
            _ => replier.reply(id, body),
        }
    }
    let mut events = Vec::new();
    tokio::select! {
        event = replied(&mut replier) => panic!("{event:?}"),
        () = async { for _ in 0..3 { events.push(requested(&mut requester).await) } } => (),
    }
    assert_eq!(events[0], RequesterEvent::Gone { id: 12 });
    assert!(events[1] == RequesterEvent::Reply { id: 11, body: large });
    assert_eq!(events[2], RequesterEvent::Reply { id: 10, body: Bytes::from_static(b"ten") });
}

async fn assert_nothing_yet(requester: &mut WireRequester) {
    std::future::poll_fn(|cx| {
        assert!(requester.poll_event(cx).is_pending());
        std::task::Poll::Ready(())
    })
    .await;
}

#[tokio::test]
async fn a_request_without_a_replier_is_gone() {
    let (board, _ground) = two_hosts().await;
    let mut requester = board.requester(&requests("board", "ground", "mode"));
    requester.request(1, Bytes::from_static(b"too early"));
    assert_eq!(requested(&mut requester).await, RequesterEvent::Gone { id: 1 });
}

#[tokio::test]
async fn requests_are_gone_when_the_replier_closes_and_are_never_handled_by_the_next() {
    let (board, ground) = two_hosts().await;
    let (mut requester, mut replier) = both_ends(&board, &ground).await;
    requester.request(1, Bytes::from_static(b"one"));
    let (id, _) = request(&mut replier).await;
    replier.set_open(false);
    assert_eq!(requested(&mut requester).await, RequesterEvent::Gone { id: 1 });
    assert_eq!(requested(&mut requester).await, RequesterEvent::Unmatched);
    replier.reply(id, Bytes::from_static(b"too late"));
    replier.set_open(true);
    assert_eq!(requested(&mut requester).await, RequesterEvent::Matched);
    requester.request(2, Bytes::from_static(b"two"));
    let (id, body) = request(&mut replier).await;
    assert_eq!(&*body, b"two");
    replier.reply(id, body);
    assert!(matches!(requested(&mut requester).await, RequesterEvent::Reply { id: 2, .. }));
}

#[tokio::test]
async fn requests_are_gone_when_the_link_is_cut() {
    let address = free_address();
    let proxy = Proxy::to(&address).await;
    let (board, ground) = two_hosts_via(&address, &proxy.address).await;
    let (mut requester, mut replier) = both_ends(&board, &ground).await;
    requester.request(1, Bytes::from_static(b"one"));
    let (old, _) = request(&mut replier).await;
    proxy.set(Weather::Cut);
    assert_eq!(requested(&mut requester).await, RequesterEvent::Gone { id: 1 });
    assert_eq!(requested(&mut requester).await, RequesterEvent::Unmatched);
    assert_eq!(replied(&mut replier).await, ReplierEvent::Unmatched);
    proxy.set(Weather::Good);
    assert_eq!(requested(&mut requester).await, RequesterEvent::Matched);
    assert_eq!(replied(&mut replier).await, ReplierEvent::Matched);
    replier.reply(old, Bytes::from_static(b"too late"));
    requester.request(2, Bytes::from_static(b"two"));
    let (id, body) = request(&mut replier).await;
    assert_eq!(&*body, b"two");
    replier.reply(id, Bytes::from_static(b"in time"));
    let reply = RequesterEvent::Reply { id: 2, body: Bytes::from_static(b"in time") };
    let event = tokio::select! {
        event = requested(&mut requester) => event,
        event = replied(&mut replier) => panic!("{event:?}"),
    };
    assert_eq!(event, reply);
}
