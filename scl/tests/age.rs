//! `max_age`: a program gets no message that is too old for it, and each of those is counted.
#![allow(clippy::unwrap_used)]

use super::untyped::on_each_transport_async;
use scl::GateStats;
use std::time::{Duration, Instant};

scl::topology!("age.yaml");

/// A limit that no passing test reaches.
const LONG: Duration = Duration::from_secs(300);
/// The shorter age in the topology.
const MAX_AGE: Duration = Duration::from_millis(20);

/// Lets messages become too old while they wait at the receiver, and sends more until one comes.
macro_rules! old_ones_are_dropped {
    ($source:ident, $sink:ident, $gate:ident, $try:ident) => {{
        for number in 0..3 {
            $source.$gate.send(&number).await.unwrap();
        }
        // With `queue: 1`, a message may be replaced at either end.
        let replaced = || $source.$gate.peer_stats()[0].replaced;
        until(|| $sink.$gate.stats().received + replaced() == 3).await;
        older_than(Instant::now(), MAX_AGE).await;
        assert_eq!($sink.$gate.$try().unwrap(), None);
        let old = $sink.$gate.stats();
        assert_eq!(done(&old) + replaced(), 3, "{old:?}");
        let mut sent = 3;
        let got = loop {
            $source.$gate.send(&sent).await.unwrap();
            sent += 1;
            // On a busy machine, a message that was just sent may be too old, too.
            let mut got = None;
            until(|| {
                got = got.or($sink.$gate.$try().unwrap());
                got.is_some() || done(&$sink.$gate.stats()) + $source.$gate.peer_stats()[0].replaced == u64::from(sent)
            })
            .await;
            if let Some(got) = got {
                break got;
            }
        };
        assert_eq!(got, sent - 1, "the messages before it were too old");
        let stats = $sink.$gate.stats();
        let replaced = $source.$gate.peer_stats()[0].replaced;
        let counted = (stats.received + replaced, done(&stats) + replaced);
        assert_eq!(counted, (u64::from(sent), u64::from(sent) - 1), "{stats:?}");
        old.expired
    }};
}

#[test]
fn messages_that_became_too_old_at_the_receiver_are_dropped_and_counted() {
    on_each_transport_async(|options| async move {
        let mut source = Source::open_with(options.clone()).await.unwrap();
        let mut sink = Sink::open_with(options).await.unwrap();
        source.ready(LONG).await.unwrap();
        sink.ready(LONG).await.unwrap();
        until(|| source.brief.is_connected() && source.newest.is_connected() && source.jobs.is_connected()).await;
        assert_eq!(old_ones_are_dropped!(source, sink, brief, try_recv), 3);
        assert_eq!(old_ones_are_dropped!(source, sink, jobs, try_recv), 3);
        assert_eq!(old_ones_are_dropped!(source, sink, newest, latest), 1, "of three, two were replaced");
    });
}

#[test]
fn the_age_includes_the_time_at_the_sender() {
    on_each_transport_async(|options| async move {
        let mut source = Source::open_with(options.clone()).await.unwrap();
        for number in 0..3 {
            source.brief.send(&number).await.unwrap();
            source.jobs.send(&number).await.unwrap();
        }
        let sent = Instant::now();
        older_than(sent, MAX_AGE).await;
        let mut sink = Sink::open_with(options).await.unwrap();
        until(|| {
            assert_eq!((sink.brief.try_recv().unwrap(), sink.jobs.try_recv().unwrap()), (None, None));
            sink.brief.stats().expired == 3 && sink.jobs.stats().expired == 3
        })
        .await;
        // Whether the program has waited for them or not, they were taken.
        until(|| source.brief.peer_stats()[0].taken == 3).await;
    });
}

#[test]
fn the_last_message_of_a_sender_that_keeps_it_has_its_age() {
    on_each_transport_async(|options| async move {
        let mut source = Source::open_with(options.clone()).await.unwrap();
        source.state.send(&7).await.unwrap();
        older_than(Instant::now(), MAX_AGE).await;
        let mut witness = Witness::open_with(options.clone()).await.unwrap();
        assert_eq!(witness.state.recv().await.unwrap(), 7);
        assert!(witness.state.latched_age().unwrap() > MAX_AGE);
        let mut sink = Sink::open_with(options).await.unwrap();
        until(|| {
            assert_eq!(sink.state.try_recv().unwrap(), None);
            sink.state.stats().expired == 1
        })
        .await;
        assert_eq!(witness.state.stats().expired, 0);
    });
}

#[test]
fn messages_that_are_young_enough_all_come_in_order() {
    const MANY: u32 = 900;
    on_each_transport_async(|options| async move {
        let mut source = Source::open_with(options.clone()).await.unwrap();
        for number in 0..MANY {
            source.lasting.send(&number).await.unwrap();
        }
        let mut sink = Sink::open_with(options.clone()).await.unwrap();
        for round in 0..3 {
            for expected in 0..MANY {
                let received = tokio::time::timeout(LONG, sink.lasting.recv()).await.unwrap().unwrap();
                assert_eq!(received, round * MANY + expected);
            }
            for number in 0..MANY {
                source.lasting.send(&((round + 1) * MANY + number)).await.unwrap();
            }
        }
        let stats = sink.lasting.stats();
        assert_eq!((stats.expired, stats.dropped_oldest, stats.dropped_newest), (0, 0, 0));
    });
}

/// Number of messages that are neither received nor on their way.
fn done(stats: &GateStats) -> u64 {
    stats.expired + stats.replaced + stats.dropped_oldest
}

async fn older_than(since: Instant, age: Duration) {
    until(|| since.elapsed() > age).await;
}

/// Lets the gates' tasks run until something holds.
async fn until(mut holds: impl FnMut() -> bool) {
    let started = Instant::now();
    while !holds() {
        assert!(started.elapsed() < LONG, "does not happen");
        tokio::task::yield_now().await;
    }
}
