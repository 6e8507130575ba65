//! Queues between components on the transport within one process: who is given room, who waits, and what is newest.
#![allow(clippy::unwrap_used)]

use scl::private::{AnyGate, Component, ComponentSpec, GateKind, GateSpec, LinkSpec, OpenError, Opener, WhenFull};
use scl::transport::memory::Memory;
use scl::{OpenOptions, Pub, Pull, Push, Sub};
use std::time::Duration;

/// How many messages the transport holds for a reader that takes none.
const ON_THE_WAY: usize = 64;

const READINGS: &str = "sensor.readings--watcher.readings.1a2b3c4d";
const NARROW: &str = "narrow.jobs.5e6f7a8b";
const WIDE: &str = "wide.jobs.5e6f7a8b";

/// It waits for `watcher`, which is optional, and shares its jobs between `narrow` and `wide`.
struct Sensor {
    readings: Pub<u32>,
    jobs: Push<u32>,
}

struct Watcher {
    readings: Sub<u32>,
}

struct Narrow {
    jobs: Pull<u32>,
}

struct Wide {
    jobs: Pull<u32>,
}

impl Component for Sensor {
    const SPEC: &'static ComponentSpec = &component(
        "sensor",
        &[
            gate("readings", GateKind::Pub, "sensor.readings", 1, &[link("watcher", "readings", READINGS, 2, false)]),
            gate(
                "jobs",
                GateKind::Push,
                "",
                1,
                &[link("narrow", "jobs", NARROW, 1, true), link("wide", "jobs", WIDE, 3, true)],
            ),
        ],
    );

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        let readings = opener.publisher::<_, scl::codec::Json>(0)?;
        Ok(Self { readings, jobs: opener.pusher::<_, scl::codec::Json>(1)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.readings, &self.jobs]
    }
}

impl Component for Watcher {
    const SPEC: &'static ComponentSpec = &component(
        "watcher",
        &[gate("readings", GateKind::Sub, "", 2, &[link("sensor", "readings", READINGS, 2, true)])],
    );

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        Ok(Self { readings: opener.subscriber::<_, scl::codec::Json>(0)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.readings]
    }
}

impl Component for Narrow {
    const SPEC: &'static ComponentSpec =
        &component("narrow", &[gate("jobs", GateKind::Pull, NARROW, 1, &[link("sensor", "jobs", NARROW, 1, true)])]);

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        Ok(Self { jobs: opener.puller::<_, scl::codec::Json>(0)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.jobs]
    }
}

impl Component for Wide {
    const SPEC: &'static ComponentSpec =
        &component("wide", &[gate("jobs", GateKind::Pull, WIDE, 3, &[link("sensor", "jobs", WIDE, 3, true)])]);

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        Ok(Self { jobs: opener.puller::<_, scl::codec::Json>(0)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.jobs]
    }
}

scl::private::component_methods!(Sensor);
scl::private::component_methods!(Watcher);
scl::private::component_methods!(Narrow);
scl::private::component_methods!(Wide);

const fn component(name: &'static str, gates: &'static [GateSpec]) -> ComponentSpec {
    ComponentSpec { system: "rover", name, place: "topology.yaml:3:3", gates }
}

const fn gate(
    name: &'static str,
    kind: GateKind,
    endpoint: &'static str,
    queue: u32,
    links: &'static [LinkSpec],
) -> GateSpec {
    GateSpec {
        name,
        kind,
        payload: "any",
        codec: "json",
        place: "topology.yaml:5:5",
        endpoint,
        queue,
        when_full: WhenFull::Wait,
        backpressure: true,
        timeout: Duration::from_secs(60),
        links,
    }
}

const fn link(
    peer_component: &'static str,
    peer_gate: &'static str,
    endpoint: &'static str,
    queue: u32,
    required: bool,
) -> LinkSpec {
    LinkSpec { peer_component, peer_gate, endpoint, contract: "1a2b3c4d", required, queue, when_full: WhenFull::Wait }
}

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
    let sent = (0..).take_while(|number| sensor.readings.try_send(number).is_ok()).count();
    assert_eq!(sent, ON_THE_WAY + 2, "the last two wait in the queue");
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
