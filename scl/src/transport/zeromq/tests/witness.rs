//! The independent library `zeromq` at the other end, in all six roles and both directions.

use super::ends::{answer, ask, echo};
use super::stage::{ENDPOINT, Stage, next, pattern};
use super::subject::{End, Role};
use crate::transport::zeromq::TransportKind;
use bytes::Bytes;
use std::future::poll_fn;
use zeromq::{
    DealerSocket, PubSocket, PullSocket, PushSocket, RepSocket, ReqSocket, RouterSocket, Socket, SocketRecv,
    SocketSend, SubSocket, ZmqMessage,
};

const SIZES: [usize; 5] = [0, 3, 255, 256, 100_000];

fn url(stage: &Stage) -> String {
    format!("ipc://{}", stage.dir.path(ENDPOINT).unwrap().display())
}

async fn connect<S: Socket>(stage: &Stage, end: &mut End) -> S {
    let mut socket = S::new();
    end.during(socket.connect(&url(stage))).await.unwrap();
    socket
}

fn single(message: ZmqMessage) -> Bytes {
    let [frame] = <[Bytes; 1]>::try_from(message.into_vec()).unwrap();
    frame
}

#[tokio::test]
async fn its_subscriber_and_puller_receive() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut publisher = Role::Publish.open(&stage);
    let mut socket: SubSocket = connect(&stage, &mut publisher).await;
    publisher.during(socket.subscribe("")).await.unwrap();
    check_sending(publisher, socket).await;

    let stage = Stage::new(TransportKind::Ipc);
    let mut socket = PullSocket::new();
    socket.bind(&url(&stage)).await.unwrap();
    check_sending(Role::Push.open(&stage), socket).await;
}

async fn check_sending(sender: End, mut socket: impl SocketRecv) {
    let End::Sender(mut sender) = sender else { unreachable!() };
    sender.until(|sender| !sender.peers.is_empty()).await;
    sender.queue(SIZES.map(pattern));
    for size in SIZES {
        let message = sender.during(socket.recv()).await.unwrap();
        assert!(single(message) == pattern(size), "{size} bytes");
    }
}

#[tokio::test]
async fn its_publisher_and_pusher_send() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut publisher = PubSocket::new();
    publisher.bind(&url(&stage)).await.unwrap();
    check_receiving(Role::Subscribe.open(&stage), publisher).await;

    let stage = Stage::new(TransportKind::Ipc);
    let mut puller = Role::Pull.open(&stage);
    let socket: PushSocket = connect(&stage, &mut puller).await;
    check_receiving(puller, socket).await;
}

async fn check_receiving(receiver: End, mut socket: impl SocketSend) {
    let End::Receiver(mut receiver) = receiver else { unreachable!() };
    let start = Bytes::from_static(b"start");
    // What is published before the subscription has arrived is lost.
    loop {
        let sent = socket.send(start.clone().into()).await;
        tokio::select! {
            biased;
            message = next(&mut *receiver) => break assert_eq!(message, start),
            () = tokio::task::yield_now() => drop(sent),
        }
    }
    for size in SIZES {
        socket.send(pattern(size).into()).await.unwrap();
        let message = loop {
            let message = next(&mut *receiver).await;
            if message != start {
                break message;
            }
        };
        assert!(message == pattern(size), "{size} bytes");
    }
}

#[tokio::test]
async fn its_requesters_are_answered() {
    for dealer in [false, true] {
        let stage = Stage::new(TransportKind::Ipc);
        let mut replier = Role::Reply.open(&stage);
        if dealer {
            let socket: DealerSocket = connect(&stage, &mut replier).await;
            check_replying(replier, socket, true).await;
        } else {
            let socket: ReqSocket = connect(&stage, &mut replier).await;
            check_replying(replier, socket, false).await;
        }
    }
}

async fn check_replying(replier: End, mut socket: impl SocketSend + SocketRecv, dealer: bool) {
    let End::Replier(mut replier) = replier else { unreachable!() };
    for size in SIZES {
        let exchange = async {
            let mut request = ZmqMessage::from(pattern(size));
            if dealer {
                request.push_front(Bytes::new());
            }
            socket.send(request).await.unwrap();
            socket.recv().await.unwrap()
        };
        let mut exchange = std::pin::pin!(exchange);
        let reply = poll_fn(|cx| {
            echo(&mut *replier, cx);
            exchange.as_mut().poll(cx)
        });
        let mut expected = pattern(size).to_vec();
        expected.reverse();
        assert_eq!(reply.await.into_vec().last().unwrap(), &expected);
    }
}

#[tokio::test]
async fn its_repliers_answer() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut socket = RepSocket::new();
    socket.bind(&url(&stage)).await.unwrap();
    check_requesting(&stage, socket).await;

    let stage = Stage::new(TransportKind::Ipc);
    let mut socket = RouterSocket::new();
    socket.bind(&url(&stage)).await.unwrap();
    check_requesting(&stage, socket).await;
}

async fn check_requesting(stage: &Stage, mut socket: impl SocketSend + SocketRecv + Send + 'static) {
    let answering = tokio::spawn(async move {
        while let Ok(request) = socket.recv().await {
            socket.send(request).await.unwrap();
        }
    });
    let mut requester = stage.requester();
    poll_fn(|cx| requester.poll_connected(cx)).await;
    let mut bystander = Stage::new(TransportKind::Ipc).replier();
    for (id, size) in (1..).zip(SIZES) {
        ask(&mut *requester, id, pattern(size)).await;
        assert!(answer(&mut *requester, &mut *bystander).await == Some((id, pattern(size))), "{size} bytes");
    }
    answering.abort();
}
