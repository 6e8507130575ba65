//! Messages of no byte, of one byte and of 64 MiB through each kind of gate; and calls that are given up half way.

use scl::OpenOptions;
use scl::bytes::Bytes;
use std::time::Duration;

scl::topology!("sizes.yaml");

const LARGE: usize = 64 << 20;
const SIZES: [usize; 6] = [0, 1, 255, 256, LARGE, 0];

async fn pair(tcp: bool) -> (tempfile::TempDir, Giver, Taker) {
    let folder = tempfile::TempDir::with_prefix("scl").expect("a folder");
    let options = || OpenOptions::new().runtime_dir(folder.path()).tcp(tcp);
    let giver = Giver::open_with(options()).await.expect("open");
    let taker = Taker::open_with(options()).await.expect("open");
    (folder, giver, taker)
}

/// A message in which each part is different.
fn message(size: usize) -> Bytes {
    (0..size).map(|index| (index * 31 % 251) as u8).collect()
}

#[tokio::test]
async fn messages_of_any_size_arrive_whole() {
    for tcp in [false, true] {
        let (_folder, mut giver, mut taker) = pair(tcp).await;
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
    let (answered, ()) = tokio::join!(giver.asked.call(sent), async {
        let question = taker.asked.recv().await.expect("asked");
        assert_eq!(question.message(), sent);
        let back = question.message().clone();
        question.reply(&back).await.expect("answered");
    });
    assert_eq!(&answered.expect("an answer"), sent);
}

async fn ask_much(giver: &mut Giver, taker: &mut Taker) {
    let sent = test::Number { value: 1, padding: message(LARGE).to_vec() };
    let (answered, ()) = tokio::join!(giver.asked_much.call(&sent), async {
        let question = taker.asked_much.recv().await.expect("asked");
        assert!(*question.message() == sent);
        let back = question.message().clone();
        question.reply(&back).await.expect("answered");
    });
    assert!(answered.expect("an answer") == sent);
}

/// A receiving call that is given up loses no message, also when it is given up while a message is half here.
#[tokio::test]
async fn a_receiving_call_that_times_out_loses_nothing() {
    // Fewer than the queues hold.
    const COUNT: usize = 90;
    let (_folder, mut giver, mut taker) = pair(false).await;
    let giving = tokio::spawn(async move {
        for index in 0..COUNT {
            // From some bytes to more than a socket holds.
            let sent = Bytes::from(vec![index as u8; 1 + index * 6000]);
            giver.published.send(&sent).await.expect("published");
            giver.pushed.send(&sent).await.expect("pushed");
        }
        giver.close(Duration::from_secs(60)).await.expect("handed over");
    });
    let (mut published, mut pushed, mut given_up) = (0, 0, 0);
    while published < COUNT || pushed < COUNT {
        match tokio::time::timeout(Duration::from_micros(50), taker.published.recv()).await {
            Ok(received) => {
                assert_eq!(received.expect("received").len(), 1 + published * 6000);
                published += 1;
            }
            Err(_given_up) => given_up += 1,
        }
        match tokio::time::timeout(Duration::from_micros(50), taker.pushed.recv()).await {
            Ok(received) => {
                assert_eq!(received.expect("pulled").len(), 1 + pushed * 6000);
                pushed += 1;
            }
            Err(_given_up) => given_up += 1,
        }
    }
    giving.await.expect("given");
    assert!(given_up > 0, "some calls were given up");
}

/// A call that is given up may still be answered; the next call gets its own answer.
#[tokio::test]
async fn a_call_that_times_out_never_answers_the_next() {
    let (_folder, mut giver, mut taker) = pair(false).await;
    let mut late = Vec::new();
    for index in 0..20_u8 {
        let question = Bytes::from(vec![index]);
        let given_up = tokio::select! {
            biased;
            heard = taker.asked.recv() => heard.expect("asked"),
            _ = giver.asked.call(&question) => unreachable!("nobody has answered"),
        };
        late.push(given_up);
        let own = Bytes::from(vec![index, index]);
        let (answered, ()) = tokio::join!(giver.asked.call(&own), async {
            let asked = taker.asked.recv().await.expect("asked");
            for late in late.drain(..) {
                let echo = late.message().clone();
                late.reply(&echo).await.expect("answered late");
            }
            let echo = asked.message().clone();
            asked.reply(&echo).await.expect("answered");
        });
        assert_eq!(answered.expect("an answer"), own);
    }
}
