use super::*;

fn header() -> Header {
    Header { kind: Kind::Whole, stream: 1, epoch: 2, attempt: 0, sequence: 3, latched: None }
}

fn open() -> (Lane, Instant) {
    let mut lane = Lane::new();
    lane.set_open(true);
    (lane, Instant::now())
}

/// Everything that the window allows: the ends whose pieces leave, and the last mark.
fn drain(lane: &mut Lane, now: Instant) -> (Vec<EndId>, usize, u64) {
    let (mut ends, mut bytes, mut last) = (Vec::new(), 0, 0);
    while let Some(emission) = lane.next(now) {
        match emission {
            Emission::Piece { id, payload, .. } => {
                ends.push(id);
                bytes += payload.len();
            }
            Emission::Mark(number) => last = number,
        }
    }
    (ends, bytes, last)
}

#[test]
fn routes_take_turns_and_a_small_message_does_not_wait_for_a_large_one() {
    let (mut lane, now) = open();
    let (large, small) = (EndId::next(), EndId::next());
    lane.push(large, header(), Bytes::from(vec![0; 5 * PIECE]));
    lane.push(small, header(), Bytes::from_static(b"small"));
    assert_eq!(drain(&mut lane, now).0, [large, small, large, large, large, large]);
}

#[test]
fn pieces_say_where_they_belong() {
    let (mut lane, now) = open();
    lane.push(EndId::next(), header(), Bytes::from(vec![0; PIECE + 1]));
    let mut kinds = Vec::new();
    while let Some(emission) = lane.next(now) {
        if let Emission::Piece { header, payload, .. } = emission {
            kinds.push((header.kind, payload.len()));
        }
    }
    let kind = |offset| Kind::Chunk { offset, total: PIECE as u64 + 1 };
    assert_eq!(kinds, [(kind(0), PIECE), (kind(PIECE as u64), 1)]);
}

#[test]
fn no_more_than_the_window_leaves_until_an_echo_comes() {
    let (mut lane, now) = open();
    lane.push(EndId::next(), header(), Bytes::from(vec![0; 4 * LARGEST_WINDOW]));
    let (_, bytes, last) = drain(&mut lane, now);
    assert!((LARGEST_WINDOW - PIECE..=LARGEST_WINDOW + PIECE).contains(&bytes), "{bytes}");
    lane.echo(last, now);
    assert!(drain(&mut lane, now).1 >= LARGEST_WINDOW - PIECE - BETWEEN_MARKS);
}

#[test]
fn a_slow_link_shrinks_the_window_and_a_fast_one_lets_it_grow() {
    let (mut lane, mut now) = open();
    lane.push(EndId::next(), header(), Bytes::from(vec![0; 100 * LARGEST_WINDOW]));
    let mut turn = |lane: &mut Lane, round_trip: u64| {
        let (_, bytes, last) = drain(lane, now);
        now += Duration::from_millis(round_trip);
        lane.echo(last, now);
        bytes
    };
    turn(&mut lane, 10);
    for _ in 0..5 {
        turn(&mut lane, 1000);
    }
    assert!(turn(&mut lane, 10) <= SMALLEST_WINDOW + PIECE);
    for _ in 0..20 {
        turn(&mut lane, 10);
    }
    assert!(turn(&mut lane, 10) >= LARGEST_WINDOW - BETWEEN_MARKS - PIECE);
}

#[test]
fn a_mark_without_an_echo_is_repeated_less_and_less_often() {
    let (mut lane, now) = open();
    lane.push(EndId::next(), header(), Bytes::from(vec![0; 4 * LARGEST_WINDOW]));
    let (_, _, last) = drain(&mut lane, now);
    assert_eq!(lane.repeat(now), None);
    let first = lane.deadline().expect("a deadline");
    assert_eq!(lane.repeat(first), Some(Emission::Mark(last)));
    assert!(lane.deadline().expect("a deadline") - first > REPEAT_MARK);
    lane.echo(last, first);
    assert_eq!(lane.deadline(), None);
}

#[test]
fn nothing_leaves_while_the_host_is_away_and_what_is_cleared_never_does() {
    let mut lane = Lane::new();
    let now = Instant::now();
    let (first, second) = (EndId::next(), EndId::next());
    lane.push(first, header(), Bytes::from_static(b"first"));
    lane.push(second, header(), Bytes::from_static(b"second"));
    assert_eq!(lane.next(now), None);
    lane.clear(first);
    lane.set_open(true);
    assert_eq!(drain(&mut lane, now).0, [second]);
    assert!(lane.queues.is_empty() && lane.turns.is_empty());
}
