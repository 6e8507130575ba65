use std::collections::VecDeque;

use super::super::outgoing::Outgoing;
use super::*;

fn header(sequence: u64) -> Header {
    Header { kind: Kind::Whole, stream: 1, epoch: 7, attempt: 0, sequence, latched: None }
}

fn probe(sequence: u64) -> Header {
    Header { kind: Kind::Probe { flush: false }, ..header(sequence) }
}

fn accept(incoming: &mut Incoming, header: Header) -> Outcome {
    incoming.accept(header, Bytes::from_static(b"body"))
}

#[test]
fn what_comes_twice_is_not_delivered_twice() {
    let mut incoming = Incoming::new(7, 100);
    assert!(accept(&mut incoming, header(1)).message.is_some());
    let again = accept(&mut incoming, header(1));
    assert_eq!((again.message, again.answer.map(|ack| ack.received)), (None, Some(1)));
}

#[test]
fn a_gap_is_reported_once_and_nothing_behind_it_is_delivered() {
    let mut incoming = Incoming::new(7, 100);
    accept(&mut incoming, header(1));
    let gap = accept(&mut incoming, header(3));
    assert_eq!(gap.message, None);
    assert_eq!(gap.answer.map(|ack| (ack.received, ack.seen)), Some((1, 3)));
    assert_eq!(accept(&mut incoming, header(4)), Outcome::default());
    assert!(accept(&mut incoming, header(2)).message.is_some());
}

#[test]
fn a_probe_is_always_answered_also_if_nothing_arrived() {
    let mut incoming = Incoming::new(7, 100);
    for _ in 0..2 {
        let answer = accept(&mut incoming, probe(2)).answer.expect("an answer");
        assert_eq!((answer.received, answer.seen), (0, 2));
    }
    assert_eq!(accept(&mut incoming, Header { epoch: 8, ..probe(2) }), Outcome::default());
}

#[test]
fn pieces_make_a_message_only_in_order_and_of_one_attempt() {
    let mut incoming = Incoming::new(7, 100);
    let piece = |offset, attempt| Header { kind: Kind::Chunk { offset, total: 8 }, attempt, ..header(1) };
    assert_eq!(accept(&mut incoming, piece(0, 0)), Outcome::default());
    assert_eq!(accept(&mut incoming, piece(4, 1)).message, None);
    assert_eq!(accept(&mut incoming, piece(0, 1)), Outcome::default());
    assert_eq!(accept(&mut incoming, piece(4, 1)).message, Some(Bytes::from_static(b"bodybody")));
    assert_eq!(accept(&mut incoming, piece(4, 1)).message, None);
}

#[test]
fn a_message_that_is_too_large_is_not_kept() {
    let mut incoming = Incoming::new(7, 6);
    for (offset, total) in [(0, 8), (u64::MAX, u64::MAX), (4, 6)] {
        let header = Header { kind: Kind::Chunk { offset, total }, ..header(1) };
        assert_eq!(accept(&mut incoming, header).message, None);
    }
    assert!(Incoming::new(7, 3).accept(header(1), Bytes::from_static(b"body")).too_large);
}

#[test]
fn counts_of_taken_messages_are_of_this_stream() {
    let mut incoming = Incoming::new(7, 100);
    (1..=3).for_each(|sequence| drop(accept(&mut incoming, header(sequence))));
    assert_eq!(incoming.acknowledge(2).map(|ack| ack.taken), Some(2));
    accept(&mut incoming, Header { stream: 2, ..header(1) });
    assert_eq!(incoming.acknowledge(3).map(|ack| (ack.received, ack.taken)), Some((1, 0)));
    assert_eq!(incoming.acknowledge(4).map(|ack| ack.taken), Some(1));
    // More than arrived cannot be taken.
    assert_eq!(incoming.acknowledge(9).map(|ack| ack.taken), Some(1));
}

/// Both ends over a link that loses, cuts and replaces at random: everything that is not given up arrives once and in
/// order, and nothing that is given up arrives at the new receiver.
#[test]
fn any_sequence_of_losses_cuts_and_replacements_keeps_the_accounts() {
    for seed in 1..200_u64 {
        let mut random = seed;
        let mut next = |limit: u64| {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            random % limit
        };
        let (mut outgoing, mut epoch) = (Outgoing::new(8, false, 1), 1);
        let mut incoming = Incoming::new(epoch, 100);
        let (mut link, mut answers) = (VecDeque::new(), VecDeque::new());
        let (mut pushed, mut given_up, mut expected, mut taken) = (0_u64, 0, 0_u64, 0);
        let (mut settled, mut is_new) = (0, false);
        outgoing.matched(epoch);
        for step in 0..2000 {
            let is_calm = step > 1500;
            match next(if is_calm { 8 } else { 11 }) {
                0 if pushed < (if is_calm { 110 } else { 100 }) && outgoing.may_push(8) => {
                    outgoing.push(Bytes::copy_from_slice(&pushed.to_be_bytes()), None);
                    pushed += 1;
                }
                0 | 1 => link.extend(outgoing.emit()),
                2 => link.extend(outgoing.probe().map(|header| (header, Bytes::new()))),
                3..6 => {
                    let Some((header, message)) = link.pop_front() else { continue };
                    let outcome = incoming.accept(header, message);
                    answers.extend(outcome.answer);
                    if let Some(message) = outcome.message {
                        let number = u64::from_be_bytes(message[..].try_into().expect("a number"));
                        assert!(number >= expected, "seed {seed}: {number} after {expected}");
                        // Only another receiver may miss messages, and only those before its first.
                        assert!(number == expected || is_new, "seed {seed}: {expected} is missing");
                        is_new = false;
                        expected = number + 1;
                        taken += 1;
                        answers.extend(incoming.acknowledge(taken));
                    }
                }
                6 | 7 => {
                    let Some(answer) = answers.pop_front() else { continue };
                    let progress = outgoing.acknowledged(&answer);
                    settled = progress.settled.unwrap_or(settled);
                    if progress.started_over {
                        link.clear();
                    }
                }
                8 => drop(link.pop_front()),
                9 => drop(answers.pop_front()),
                _ => {
                    outgoing.unmatched();
                    (link, answers) = (VecDeque::new(), VecDeque::new());
                    if next(4) == 0 {
                        epoch += 1;
                        (incoming, taken, is_new) = (Incoming::new(epoch, 100), 0, true);
                    }
                    given_up += outgoing.matched(epoch);
                }
            }
        }
        assert_eq!(outgoing.unacknowledged(), 0, "seed {seed}");
        assert!(settled <= pushed && given_up <= pushed, "seed {seed}");
        assert_eq!(expected, pushed, "seed {seed}: the last message arrived");
    }
}
