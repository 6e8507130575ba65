//! Messages from no bytes to 64 MiB through each kind of gate, and calls that are cancelled half way.

use scl::bytes::Bytes;
use scl::{OpenOptions, TransportKind};
use std::time::Duration;

scl::topology!("topologies/sizes.yaml");

/// The default limit of a message, less what protobuf puts around the bytes.
const LARGE: usize = (64 << 20) - 16;
const SIZES: [usize; 6] = [0, 1, 255, 256, LARGE, 0];

async fn pair(kind: TransportKind) -> (tempfile::TempDir, Giver, Taker) {
    let folder = tempfile::TempDir::with_prefix("scl").expect("a folder");
    let options = || OpenOptions::new().runtime_dir(folder.path()).transport_kind(kind);
    let giver = Giver::open_with(options()).await.expect("open");
    let taker = Taker::open_with(options()).await.expect("open");
    (folder, giver, taker)
}

/// A message whose parts all differ.
fn message(size: usize) -> Bytes {
    (0..size).map(|index| (index * 31 % 251) as u8).collect()
}

#[tokio::test]
async fn messages_of_any_size_arrive_whole() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let (_folder, mut giver, mut taker) = pair(kind).await;
        for size in SIZES {
            let sent = message(size);
            let (given, taken) = tokio::join!(giver.published.send(&sent), taker.published.recv());
            given.expect("published");
            assert!(taken.expect("received") == sent, "{size} bytes, published");
            let (given, taken) = tokio::join!(giver.pushed.send(&sent), taker.pushed.recv());
            given.expect("pushed");
            assert!(taken.expect("pulled") == sent, "{size} bytes, pushed");
            if size < LARGE {
                ask(&mut giver, &mut taker, &sent).await;
            }
        }
        ask_much(&mut giver, &mut taker).await;
    }
}

async fn ask(giver: &mut Giver, taker: &mut Taker, sent: &Bytes) {
    let (reply, ()) = tokio::join!(giver.asked.call(sent), async {
        let request = taker.asked.recv().await.expect("a request");
        assert_eq!(request.message(), sent);
        let echo = request.message().clone();
        request.reply(&echo).expect("replied");
    });
    assert_eq!(&reply.expect("a reply"), sent);
}

async fn ask_much(giver: &mut Giver, taker: &mut Taker) {
    let sent = test::Number { value: 1, padding: message(LARGE).to_vec() };
    let (reply, ()) = tokio::join!(giver.asked_much.call(&sent), async {
        let request = taker.asked_much.recv().await.expect("a request");
        assert!(*request.message() == sent);
        let echo = request.message().clone();
        request.reply(&echo).expect("replied");
    });
    assert!(reply.expect("a reply") == sent);
}

/// A receiving call that is cancelled loses no message, even if part of a message has arrived by then.
#[tokio::test]
async fn a_receiving_call_that_times_out_loses_nothing() {
    // Fewer than the queues hold.
    const COUNT: usize = 90;
    let (_folder, mut giver, mut taker) = pair(TransportKind::Ipc).await;
    let giving = tokio::spawn(async move {
        giver.ready(Duration::from_secs(300)).await.expect("ready");
        for index in 0..COUNT {
            // From a few bytes to more than a socket holds.
            let sent = Bytes::from(vec![index as u8; 1 + index * 6000]);
            giver.published.send(&sent).await.expect("published");
            giver.pushed.send(&sent).await.expect("pushed");
        }
        giver.close(Duration::from_secs(300)).await.expect("everything is handed over");
    });
    let (mut published, mut pushed, mut cancelled) = (0, 0, 0);
    while published < COUNT || pushed < COUNT {
        match tokio::time::timeout(Duration::from_micros(50), taker.published.recv()).await {
            Ok(received) => {
                assert_eq!(received.expect("received").len(), 1 + published * 6000);
                published += 1;
            }
            Err(_timeout) => cancelled += 1,
        }
        match tokio::time::timeout(Duration::from_micros(50), taker.pushed.recv()).await {
            Ok(received) => {
                assert_eq!(received.expect("pulled").len(), 1 + pushed * 6000);
                pushed += 1;
            }
            Err(_timeout) => cancelled += 1,
        }
    }
    giving.await.expect("given");
    assert!(cancelled > 0, "some calls were cancelled");
}

/// A call that is cancelled may still be answered; the next call gets its own reply.
#[tokio::test]
async fn a_cancelled_call_never_answers_the_next() {
    let (_folder, mut giver, mut taker) = pair(TransportKind::Ipc).await;
    let mut late = Vec::new();
    for index in 0..20_u8 {
        let body = Bytes::from(vec![index]);
        let unanswered = tokio::select! {
            biased;
            request = taker.asked.recv() => request.expect("a request"),
            _ = giver.asked.call(&body) => unreachable!("nobody has replied"),
        };
        late.push(unanswered);
        let own = Bytes::from(vec![index, index]);
        let (reply, ()) = tokio::join!(giver.asked.call(&own), async {
            let request = taker.asked.recv().await.expect("a request");
            for late in late.drain(..) {
                let echo = late.message().clone();
                late.reply(&echo).expect("replied late");
            }
            let echo = request.message().clone();
            request.reply(&echo).expect("replied");
        });
        assert_eq!(reply.expect("a reply"), own);
    }
}
