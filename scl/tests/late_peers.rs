//! Peers that start while a gate has no room for what the others have sent.
#![allow(clippy::unwrap_used)]

use super::untyped::on_each_transport_async;
use std::time::Duration;

scl::topology!("late_peers.yaml");

/// Far longer than anything takes.
const LONG: Duration = Duration::from_secs(300);

#[test]
fn all_get_ready_although_the_first_has_filled_the_queues() {
    on_each_transport_async(|options| async move {
        let mut first = First::open_with(options.clone()).await.unwrap();
        let mut reader = Reader::open_with(options.clone()).await.unwrap();
        first.ready(LONG).await.unwrap();
        // More than everything on the way holds: both calls wait for the reader.
        let sending = tokio::spawn(async move {
            for number in 0..1000 {
                first.readings.send(&number).await.unwrap();
                first.jobs.send(&number).await.unwrap();
            }
            first
        });
        while reader.readings.stats().waiting + reader.jobs.stats().waiting < 4 {
            tokio::task::yield_now().await;
        }
        let mut second = Second::open_with(options).await.unwrap();
        second.ready(LONG).await.unwrap();
        reader.ready(LONG).await.unwrap();
        second.readings.send(&1000).await.unwrap();
        second.jobs.send(&1000).await.unwrap();
        let (mut readings, mut jobs) = (0, 0);
        while (readings, jobs) != (1001, 1001) {
            tokio::select! {
                reading = reader.readings.recv() => readings += reading.map(|_| 1).unwrap(),
                job = reader.jobs.recv() => jobs += job.map(|_| 1).unwrap(),
            }
        }
        sending.await.unwrap();
    });
}
