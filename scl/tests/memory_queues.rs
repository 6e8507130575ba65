//! Queues between components on the transport within one process: who is given room, who waits, and what is newest.
#![allow(clippy::unwrap_used)]

use scl::OpenOptions;
use scl::transport::memory::Memory;

scl::topology!("memory_queues.yaml");

/// How many messages the transport holds for a reader that takes none.
const ON_THE_WAY: usize = 64;

#[tokio::test]
async fn the_latest_message_is_the_newest_also_where_the_publisher_waits() {
    let (mut sensor, mut watcher) = sensor_and_watcher().await;
    for number in 0..5 {
        sensor.readings.send(&number).await.unwrap();
    }
    assert_eq!(watcher.readings.latest().unwrap(), Some(4));
    assert_eq!(watcher.readings.latest().unwrap(), None);
    sensor.readings.send(&5).await.unwrap();
    assert_eq!(watcher.readings.recv().await.unwrap(), 5);
}

#[tokio::test]
async fn a_job_goes_where_there_is_room_and_nothing_is_dropped() {
    let options = OpenOptions::new().transport(Memory::new());
    let mut sensor = Sensor::open_with(options.clone()).await.unwrap();
    let sent = (0..10).filter(|number| sensor.jobs.try_send(number).is_ok()).count();
    assert_eq!((sent, sensor.jobs.stats().dropped_oldest), (4, 0), "as many as both queues hold");
    let mut narrow = Narrow::open_with(options.clone()).await.unwrap();
    let mut wide = Wide::open_with(options).await.unwrap();
    let mut jobs = vec![narrow.jobs.recv().await.unwrap()];
    for _ in 0..3 {
        jobs.push(wide.jobs.recv().await.unwrap());
    }
    jobs.sort_unstable();
    assert_eq!(jobs, [0, 1, 2, 3]);
}

#[tokio::test]
async fn a_publisher_that_waits_goes_on_when_an_optional_reader_has_gone() {
    let (mut sensor, watcher) = sensor_and_watcher().await;
    // The watcher's gate takes in as many as its own queue holds; the transport and the publisher's queue hold the
    // rest.
    let mut sent = 0;
    for _ in 0..100 {
        sent += (0..).take_while(|number| sensor.readings.try_send(number).is_ok()).count();
        tokio::task::yield_now().await;
    }
    assert_eq!(sent, 2 + ON_THE_WAY + 2);
    let sends = tokio::spawn(async move { sensor.readings.send(&0).await });
    tokio::task::yield_now().await;
    assert!(!sends.is_finished(), "there is no room");
    drop(watcher);
    for _ in 0..10 {
        tokio::task::yield_now().await;
    }
    assert!(sends.is_finished(), "nobody is there to be waited for");
    sends.await.unwrap().unwrap();
}

/// Both, connected.
async fn sensor_and_watcher() -> (Sensor, Watcher) {
    let options = OpenOptions::new().transport(Memory::new());
    let sensor = Sensor::open_with(options.clone()).await.unwrap();
    let watcher = Watcher::open_with(options).await.unwrap();
    while sensor.readings.stats().peers == 0 {
        tokio::task::yield_now().await;
    }
    (sensor, watcher)
}
