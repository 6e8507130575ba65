//! `rate`, `period` and `deadline`: messages that do not come in time are counted where they were due.
#![allow(clippy::unwrap_used)]

use super::untyped::on_each_transport_async;
use std::time::{Duration, Instant};

scl::topology!("due.yaml");

/// A limit that no passing test reaches.
const LONG: Duration = Duration::from_secs(300);
/// The periods and the deadlines in the topology.
const PERIOD: Duration = Duration::from_millis(20);
const DEADLINE: Duration = Duration::from_millis(50);

#[test]
fn messages_that_come_in_time_are_not_missed() {
    on_each_transport_async(|options| async move {
        let (mut source, mut sink, mut last) = open(options).await;
        // On a busy machine some are late, but never more than the time between them allows for.
        let (mut sent_late, mut came_late) = (0, 0);
        let mut allow_for = |gap: Duration| {
            sent_late += gap.as_nanos() / PERIOD.as_nanos();
            came_late += gap.as_nanos() / DEADLINE.as_nanos();
        };
        for number in 0..20 {
            until(|| last.elapsed() >= PERIOD / 2).await;
            let sends = Instant::now();
            exchange(&mut source, &mut sink, number).await;
            allow_for(last.elapsed());
            last = sends;
        }
        let sent = [source.often.stats().missed, source.jobs.stats().missed];
        let came = [sink.often.stats().missed, sink.jobs.stats().missed];
        allow_for(last.elapsed());
        assert!(sent.iter().all(|missed| u128::from(*missed) <= sent_late), "{sent:?} of {sent_late}");
        assert!(came.iter().all(|missed| u128::from(*missed) <= came_late), "{came:?} of {came_late}");
    });
}

#[test]
fn messages_that_do_not_come_are_counted_at_both_ends() {
    on_each_transport_async(|options| async move {
        let (mut source, mut sink, started) = open(options).await;
        source.seldom.send(&1).await.unwrap();
        assert_eq!(sink.seldom.recv().await.unwrap(), 1);
        for number in 0..3 {
            exchange(&mut source, &mut sink, number).await;
            let expected = u64::from(number + 1) * 3;
            let sent = |source: &Source| source.often.stats().missed.min(source.jobs.stats().missed);
            let received = |sink: &Sink| sink.often.stats().missed.min(sink.jobs.stats().missed);
            until(|| sent(&source) >= expected && received(&sink) >= expected).await;
        }
        // Counts do not exceed the time that has passed.
        for missed in [sink.often.stats().missed, sink.jobs.stats().missed] {
            assert!(u128::from(missed) <= started.elapsed().as_nanos() / DEADLINE.as_nanos(), "{missed}");
        }
        assert_eq!((source.seldom.stats().missed, sink.seldom.stats().missed), (0, 0));
        // A sender that was connected and does not run is missed.
        drop(source);
        until(|| sink.often.stats().peers == 0).await;
        let before = sink.often.stats().missed;
        until(|| sink.often.stats().missed > before + 1).await;
    });
}

#[test]
fn nothing_is_due_while_an_optional_sender_does_not_run() {
    on_each_transport_async(|options| async move {
        let sink = Sink::open_with(options.clone()).await.unwrap();
        for _ in 0..2 {
            let visitor = Visitor::open_with(options.clone()).await.unwrap();
            let before = sink.ticks.stats().missed;
            until(|| sink.ticks.stats().missed > before).await;
            assert_eq!(visitor.ticks.stats().missed, 0, "nothing is promised before the first message");
            drop(visitor);
            // The gate learns at some time that the sender has gone; from then on, the count stays.
            let (mut count, mut since) = (sink.ticks.stats().missed, Instant::now());
            until(|| {
                let now = sink.ticks.stats().missed;
                if std::mem::replace(&mut count, now) != now {
                    since = Instant::now();
                }
                since.elapsed() > 4 * DEADLINE
            })
            .await;
        }
    });
}

#[test]
fn a_program_waits_for_messages_that_do_not_come() {
    on_each_transport_async(|options| async move {
        let (mut source, mut sink, _) = open(options).await;
        exchange(&mut source, &mut sink, 0).await;
        let (mut told, mut jobs_told) = (0, 0);
        for _ in 0..3 {
            // The future waits while the gate receives.
            let (missed, jobs_missed) = (sink.often.deadline_missed(), sink.jobs.deadline_missed());
            source.often.send(&1).await.unwrap();
            assert_eq!(sink.often.recv().await.unwrap(), 1);
            for (missed, told) in [(missed.await, &mut told), (jobs_missed.await, &mut jobs_told)] {
                assert!(*missed.as_ref().unwrap() > 0);
                *told += missed.unwrap();
            }
            assert!(told <= sink.often.stats().missed && jobs_told <= sink.jobs.stats().missed, "none is told twice");
        }
        // A future that is dropped has told nothing.
        let before = sink.often.stats().missed;
        until(|| sink.often.stats().missed > before).await;
        drop(sink.often.deadline_missed());
        told += sink.often.take_missed().unwrap();
        assert!(told > before, "each is told");
        assert!(sink.jobs.take_missed().unwrap() > 0);
        assert_eq!(sink.seldom.take_missed().unwrap(), 0);
    });
}

#[test]
fn waiting_for_a_missed_message_ends_with_the_gate() {
    on_each_transport_async(|options| async move {
        let mut sink = Sink::open_with(options).await.unwrap();
        assert!(matches!(sink.whenever.take_missed(), Err(scl::RecvError::NoDeadline { .. })));
        let error = sink.whenever.deadline_missed().await.unwrap_err().to_string();
        assert_eq!(
            error,
            "gate `sink.whenever` has no `deadline`; declare one in the topology to be told of messages that do not come"
        );
        // No sender has connected, so nothing is due.
        let waits = tokio::spawn(sink.ticks.deadline_missed());
        tokio::task::yield_now().await;
        drop(sink);
        let error = scl::Error::from(tokio::time::timeout(LONG, waits).await.unwrap().unwrap().unwrap_err());
        assert_eq!(format!("{error:?}"), "gate `sink.ticks` did not receive\n  caused by: the component was closed");
    });
}

/// Both components, and a time before they were connected.
async fn open(options: scl::OpenOptions) -> (Source, Sink, Instant) {
    let started = Instant::now();
    let source = Source::open_with(options.clone()).await.unwrap();
    let sink = Sink::open_with(options).await.unwrap();
    source.ready(LONG).await.unwrap();
    sink.ready(LONG).await.unwrap();
    (source, sink, started)
}

/// Sends a message over both kinds of gates.
async fn exchange(source: &mut Source, sink: &mut Sink, number: u32) {
    source.often.send(&number).await.unwrap();
    source.jobs.send(&number).await.unwrap();
    assert_eq!(sink.often.recv().await.unwrap(), number);
    assert_eq!(sink.jobs.recv().await.unwrap(), number);
}

/// Lets the gates' tasks run until something holds.
async fn until(mut holds: impl FnMut() -> bool) {
    let started = Instant::now();
    while !holds() {
        assert!(started.elapsed() < LONG, "does not happen");
        tokio::task::yield_now().await;
    }
}
