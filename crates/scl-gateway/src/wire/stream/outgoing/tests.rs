use super::*;

fn message(number: u8) -> Bytes {
    Bytes::from(vec![number])
}

/// The sequence numbers of everything that can be emitted.
fn emit(outgoing: &mut Outgoing) -> Vec<u64> {
    std::iter::from_fn(|| outgoing.emit()).map(|(header, _)| header.sequence).collect()
}

fn ack(received: u64, taken: u64, seen: u64, attempt: u32) -> Ack {
    Ack { stream: 1, epoch: 7, attempt, received, taken, seen }
}

fn matched_with(count: u8) -> Outgoing {
    let mut outgoing = Outgoing::new(100, false, 1);
    outgoing.matched(7);
    (0..count).for_each(|number| outgoing.push(message(number), None));
    assert_eq!(emit(&mut outgoing).len(), usize::from(count));
    outgoing
}

#[test]
fn what_is_lost_is_emitted_again_once() {
    let mut outgoing = matched_with(5);
    let loss = ack(2, 1, 5, 0);
    assert_eq!(outgoing.acknowledged(&loss), Progress { settled: Some(1), started_over: true });
    // The same report of the old attempt says nothing about the new one.
    assert_eq!(outgoing.acknowledged(&loss), Progress::default());
    assert_eq!(emit(&mut outgoing), [3, 4, 5]);
    assert_eq!(outgoing.acknowledged(&ack(5, 5, 5, 1)), Progress { settled: Some(5), started_over: false });
    assert!(!outgoing.awaits_answer());
}

#[test]
fn the_same_receiver_gets_what_is_unacknowledged_again_and_another_one_does_not() {
    let mut outgoing = matched_with(3);
    outgoing.acknowledged(&ack(1, 1, 1, 0));
    outgoing.unmatched();
    assert!(emit(&mut outgoing).is_empty());
    assert_eq!(outgoing.matched(7), 0);
    assert_eq!(emit(&mut outgoing), [2, 3]);
    outgoing.unmatched();
    assert_eq!(outgoing.matched(8), 2);
    assert_eq!(outgoing.unacknowledged(), 0);
    outgoing.push(message(9), None);
    assert_eq!(emit(&mut outgoing), [1]);
    let of_another = ack(1, 1, 1, 0);
    assert_eq!(outgoing.acknowledged(&of_another), Progress::default());
    assert_eq!(outgoing.acknowledged(&Ack { epoch: 8, ..of_another }).settled, Some(4));
}

#[test]
fn what_never_left_is_not_given_up() {
    let mut outgoing = Outgoing::new(100, false, 1);
    outgoing.push(message(0), None);
    assert_eq!(outgoing.matched(7), 0);
    outgoing.unmatched();
    assert_eq!(outgoing.matched(8), 0);
    assert_eq!(emit(&mut outgoing), [1]);
}

#[test]
fn impossible_acknowledgements_do_no_harm() {
    let mut outgoing = matched_with(2);
    assert_eq!(outgoing.acknowledged(&ack(u64::MAX, u64::MAX, 0, 0)).settled, Some(2));
    assert_eq!(outgoing.acknowledged(&ack(0, 0, u64::MAX, 0)), Progress::default());
    assert_eq!(outgoing.unacknowledged(), 0);
}

#[test]
fn a_new_stream_does_not_wait_for_what_was_abandoned() {
    let mut outgoing = matched_with(2);
    outgoing.abandon(2);
    assert_eq!(outgoing.unacknowledged(), 0);
    outgoing.push(message(3), None);
    let (header, _) = outgoing.emit().expect("a message");
    assert_eq!((header.stream, header.sequence), (2, 1));
    assert_eq!(outgoing.acknowledged(&ack(2, 2, 2, 0)), Progress::default());
}

#[test]
fn a_flush_is_asked_for_once_for_the_same_messages() {
    let mut outgoing = matched_with(1);
    assert!(outgoing.request_flush());
    assert!(!outgoing.request_flush());
    outgoing.push(message(1), None);
    emit(&mut outgoing);
    assert!(outgoing.request_flush());
    assert_eq!(outgoing.probe().map(|probe| probe.kind), Some(Kind::Probe { flush: true }));
    outgoing.acknowledged(&ack(2, 2, 2, 0));
    assert_eq!(outgoing.probe().map(|probe| probe.kind), Some(Kind::Probe { flush: false }));
}

#[test]
fn what_waits_for_another_receiver_ends_with_the_latched_message() {
    for latches in [false, true] {
        let mut outgoing = Outgoing::new(100, latches, 1);
        let before = Instant::now();
        outgoing.matched(7);
        outgoing.unmatched();
        (0..2).for_each(|number| outgoing.push(message(number), None));
        assert_eq!(outgoing.matched(8), 0);
        outgoing.push(message(2), None);
        let emitted: Vec<_> = std::iter::from_fn(|| outgoing.emit()).map(|(header, _)| header.latched).collect();
        assert_eq!(emitted.iter().map(Option::is_some).collect::<Vec<_>>(), [false, latches, false]);
        assert!(emitted.iter().flatten().all(|sent| *sent >= before), "when it was sent");
    }
}
