//! `latched: true`: subscribers that join get the last message, once, and learn how old it is.
#![allow(clippy::unwrap_used)]

use super::untyped::on_each_transport_async;
use scl::{PeerStats, Pub, Sub};
use std::time::Instant;

scl::topology!("latched.yaml");

#[test]
fn a_subscriber_that_joins_or_restarts_gets_the_last_message_and_its_age() {
    on_each_transport_async(|options| async move {
        let mut setter = Setter::open_with(options.clone()).await.unwrap();
        let before = Instant::now();
        for mode in 0..3 {
            setter.mode.send(&mode).await.unwrap();
            setter.plain.send(&mode).await.unwrap();
        }
        for round in 0..3_u64 {
            let mut watcher = Watcher::open_with(options.clone()).await.unwrap();
            assert_eq!(watcher.mode.latched_age(), None);
            assert_eq!(watcher.mode.recv().await.unwrap(), 2, "round {round}");
            let age = watcher.mode.latched_age().unwrap();
            assert!(age <= before.elapsed(), "{age:?}");
            drop(watcher);
            gone(&mut setter.mode).await;
            let stats = to_watcher(&setter.mode);
            assert_adds_up(&stats);
            // The first time it waited for the watcher; after that it is sent again.
            let expected = (3 + round, round, 2, 1 + round, 0);
            let counted = (stats.published, stats.latched, stats.replaced, stats.taken, stats.lost);
            assert_eq!(counted, expected, "{stats:?}");
        }
        // A message that arrives while connected is not old.
        let mut watcher = Watcher::open_with(options).await.unwrap();
        assert_eq!(watcher.mode.recv().await.unwrap(), 2);
        setter.mode.send(&3).await.unwrap();
        assert_eq!((watcher.mode.recv().await.unwrap(), watcher.mode.latched_age()), (3, None));
    });
}

#[test]
fn what_waits_for_a_subscriber_is_delivered_once_and_only_the_last_of_it_is_latched() {
    on_each_transport_async(|options| async move {
        let mut setter = Setter::open_with(options.clone()).await.unwrap();
        for number in 0..5 {
            setter.mode.send(&number).await.unwrap();
            setter.plain.send(&number).await.unwrap();
        }
        let mut getter = Getter::open_with(options.clone()).await.unwrap();
        assert_eq!(received(&mut getter.mode, 3).await, [(2, false), (3, false), (4, true)]);
        assert_eq!(received(&mut getter.plain, 5).await.last(), Some(&(4, false)));
        // One that is connected gets each message once.
        setter.mode.send(&5).await.unwrap();
        assert_eq!(received(&mut getter.mode, 1).await, [(5, false)]);
        drop(getter);
        gone(&mut setter.mode).await;
        // Without `latched`, nothing is left for the next one.
        let mut getter = Getter::open_with(options).await.unwrap();
        assert_eq!(received(&mut getter.mode, 1).await, [(5, true)]);
        setter.plain.send(&6).await.unwrap();
        assert_eq!(received(&mut getter.plain, 1).await, [(6, false)]);
        for stats in setter.mode.peer_stats() {
            assert_adds_up(&stats);
        }
    });
}

#[test]
fn nothing_is_latched_before_the_first_message() {
    on_each_transport_async(|options| async move {
        let mut setter = Setter::open_with(options.clone()).await.unwrap();
        let mut watcher = Watcher::open_with(options).await.unwrap();
        while setter.mode.stats().peers == 0 {
            setter.mode.peers_changed().await;
        }
        setter.mode.send(&1).await.unwrap();
        assert_eq!((watcher.mode.recv().await.unwrap(), watcher.mode.latched_age()), (1, None));
        assert_eq!(to_watcher(&setter.mode).latched, 0);
    });
}

/// Receives messages, with whether each is latched.
async fn received(gate: &mut Sub<u32>, count: usize) -> Vec<(u32, bool)> {
    let mut received = Vec::new();
    for _ in 0..count {
        let number = gate.recv().await.unwrap();
        received.push((number, gate.latched_age().is_some()));
    }
    received
}

/// Waits until no subscriber is connected.
async fn gone(gate: &mut Pub<u32>) {
    while gate.stats().peers > 0 {
        gate.peers_changed().await;
    }
}

fn to_watcher(gate: &Pub<u32>) -> PeerStats {
    gate.peer_stats().into_iter().find(|peer| peer.peer == "watcher.mode").unwrap()
}

fn assert_adds_up(stats: &PeerStats) {
    let PeerStats { published, taken, replaced, dropped_oldest, dropped_newest, lost, waiting, .. } = stats;
    assert_eq!(*published, taken + replaced + dropped_oldest + dropped_newest + lost + waiting, "{stats:?}");
}
