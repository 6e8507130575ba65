//! Memory that links lend.

use super::ends::{TestReceiver, TestSender};
use super::{PATTERNS, content};
use crate::transport::{Frame, Loan, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::task::Poll;

/// Lengths of lent memory: the smallest that is worth lending, and longer ones.
const LENGTHS: [usize; 4] = [64 << 10, (64 << 10) + 1, 300_000, 1 << 20];
const LENGTH: usize = LENGTHS[0];

/// A transport that is tested without `lends;` lends no memory.
pub async fn lends_nothing(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        exchange(&mut sender, &mut receiver).await;
        let link = sender.link.as_mut().unwrap_or_else(|| panic!("{pattern:?}: disconnected"));
        for length in LENGTHS {
            assert!(link.watched.end.loan(length).is_none(), "{pattern:?}: lent {length} bytes; test it with `lends;`");
        }
    }
}

/// Loans arrive unchanged, in order with other messages, and are acknowledged as those are.
pub async fn carries_loans(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        for round in 0..30 {
            // Borrow memory for all messages before sending any.
            let messages = LENGTHS.map(|length| numbered_content(length, round));
            let mut frames = Vec::new();
            for message in &messages {
                frames.push(filled(&mut sender, &mut receiver, message).await);
            }
            let short = numbered_content(10, round);
            for frame in frames {
                sender.queue_frame(frame);
                sender.queue([short.clone()]);
            }
            let expected = messages.into_iter().flat_map(|message| [message, short.clone()]);
            for (index, expected) in expected.enumerate() {
                let message = receiver.next(&mut [&mut sender]).await;
                assert!(message == expected, "{pattern:?}: message {index} of round {round} is damaged");
            }
        }
        let link = sender.link.as_mut().unwrap_or_else(|| panic!("{pattern:?}: disconnected"));
        link.request_acknowledgement();
        poll_fn(|cx| {
            assert!(receiver.poll(cx).is_pending(), "{pattern:?}: received a message that was not sent");
            assert!(sender.poll(cx), "{pattern:?}: disconnected");
            let left = sender.link.as_ref().map(|link| link.watched.end.unacknowledged());
            if left == Some(0) { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
    }
}

/// A loan that the peer cannot take now is returned with its content, and sent when the peer takes messages again.
pub async fn returns_loans_that_it_refuses(transport: &dyn Transport) {
    const MESSAGES: usize = 300;
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        drop(lent(&mut sender, &mut receiver, LENGTH).await);
        for number in 0..MESSAGES {
            let message = numbered_content(LENGTH, number);
            let loan = sender.link.as_mut().and_then(|link| link.watched.end.loan(LENGTH));
            // The link may have run out of memory to lend.
            let frame = loan.map_or_else(|| message.clone().into(), |loan| fill(loan, &message));
            sender.queue_frame(frame);
            super::turns(1, |cx| assert!(sender.poll(cx), "{pattern:?}: disconnected")).await;
        }
        for number in 0..MESSAGES {
            let message = receiver.next(&mut [&mut sender]).await;
            assert!(message == numbered_content(LENGTH, number), "{pattern:?}: message {number} is damaged");
        }
    }
}

/// Loans that are dropped are not sent, and their memory is lent again.
pub async fn takes_dropped_loans_back(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        for _ in 0..1000 {
            lent(&mut sender, &mut receiver, LENGTH).await.as_mut_slice().fill(1);
        }
        let link = sender.link.as_mut().unwrap_or_else(|| panic!("{pattern:?}: disconnected"));
        let held: Vec<Loan> = (0..100).map_while(|_| link.watched.end.loan(LENGTH)).collect();
        assert!(!held.is_empty(), "{pattern:?}: dropped loans are lost");
        drop(held);
        let message = numbered_content(LENGTH, 7);
        let frame = filled(&mut sender, &mut receiver, &message).await;
        sender.queue_frame(frame);
        assert!(receiver.next(&mut [&mut sender]).await == message, "{pattern:?}: did not receive the last message");
    }
}

/// A loan of a connection that is lost is sent over the next one, as a copy.
pub async fn copies_loans_of_a_lost_link(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        let messages = [numbered_content(LENGTH, 1), numbered_content(LENGTH, 2)];
        let first = filled(&mut sender, &mut receiver, &messages[0]).await;
        let second = filled(&mut sender, &mut receiver, &messages[1]).await;
        drop(receiver);
        sender.until_connected(false).await;
        let mut receiver = pattern.receiver(transport);
        super::connect(&mut sender, &mut receiver).await;
        let own = filled(&mut sender, &mut receiver, &numbered_content(LENGTH, 3)).await;
        for frame in [first, second, own] {
            sender.queue_frame(frame);
        }
        for expected in messages.into_iter().chain([numbered_content(LENGTH, 3)]) {
            assert!(receiver.next(&mut [&mut sender]).await == expected, "{pattern:?}: a message is damaged");
        }
    }
}

/// A loan can be filled and read after its link and its sending end were dropped.
pub async fn leaves_loans_to_their_holder(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        let loan = lent(&mut sender, &mut receiver, LENGTH).await;
        drop((sender, receiver));
        let message = numbered_content(LENGTH, 5);
        assert_eq!(fill(loan, &message).as_slice(), message, "{pattern:?}");
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        exchange(&mut sender, &mut receiver).await;
    }
}

/// Waits until the link lends: it may have to agree with its peer first.
async fn lent(sender: &mut TestSender, receiver: &mut TestReceiver, length: usize) -> Loan {
    let loan = poll_fn(|cx| {
        assert!(receiver.poll(cx).is_pending(), "received a message that was not sent");
        sender.poll(cx);
        match sender.link.as_mut().and_then(|link| link.watched.end.loan(length)) {
            Some(loan) => Poll::Ready(loan),
            None => {
                cx.waker().wake_by_ref();
                Poll::Pending
            }
        }
    });
    let loan = loan.await;
    assert_eq!(loan.len(), length, "lent a different length from the requested one");
    loan
}

async fn filled(sender: &mut TestSender, receiver: &mut TestReceiver, message: &Bytes) -> Frame {
    fill(lent(sender, receiver, message.len()).await, message)
}

fn fill(mut loan: Loan, message: &[u8]) -> Frame {
    loan.as_mut_slice().copy_from_slice(message);
    loan.into()
}

/// Sends one message, so that both ends have agreed on whatever they negotiate.
async fn exchange(sender: &mut TestSender, receiver: &mut TestReceiver) {
    let message = Bytes::from_static(b"an ordinary message");
    sender.queue([message.clone()]);
    assert_eq!(receiver.next(&mut [sender]).await, message);
}

fn numbered_content(length: usize, number: usize) -> Bytes {
    let mut message = content(length).to_vec();
    message[..8].copy_from_slice(&number.to_be_bytes());
    message.into()
}
