//! Components on the transport within one process: the same gates, and no file anywhere.
#![allow(clippy::unwrap_used)]

use scl::private::{AnyGate, Component, ComponentSpec, GateKind, GateSpec, LinkSpec, OpenError, Opener, WhenFull};
use scl::transport::memory::Memory;
use scl::{OpenOptions, Pub, Rep, Req, Sub};
use std::pin::pin;
use std::task::{Context, Waker};
use std::time::Duration;

struct Sensor {
    measurements: Pub<Vec<f64>>,
    calibrate: Rep<u32, String>,
}

struct Controller {
    sensor: Sub<Vec<f64>>,
    calibrate: Req<u32, String>,
}

const MEASUREMENTS: &str = "sensor.measurements--controller.sensor.1a2b3c4d";
const CALIBRATE: &str = "sensor.calibrate.5e6f7a8b";

impl Component for Sensor {
    const SPEC: &'static ComponentSpec = &ComponentSpec {
        system: "rover",
        name: "sensor",
        place: "topology.yaml:3:3",
        gates: &[
            gate("measurements", GateKind::Pub, "sensor.measurements", &[link("controller", "sensor", MEASUREMENTS)]),
            gate("calibrate", GateKind::Rep, CALIBRATE, &[link("controller", "calibrate", CALIBRATE)]),
        ],
    };

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        let measurements = opener.publisher::<_, scl::codec::Json>(0)?;
        Ok(Self { measurements, calibrate: opener.replier::<_, _, scl::codec::Json>(1)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.measurements, &self.calibrate]
    }
}

impl Component for Controller {
    const SPEC: &'static ComponentSpec = &ComponentSpec {
        system: "rover",
        name: "controller",
        place: "topology.yaml:8:3",
        gates: &[
            gate("sensor", GateKind::Sub, "", &[link("sensor", "measurements", MEASUREMENTS)]),
            gate("calibrate", GateKind::Req, "", &[link("sensor", "calibrate", CALIBRATE)]),
        ],
    };

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        let sensor = opener.subscriber::<_, scl::codec::Json>(0)?;
        Ok(Self { sensor, calibrate: opener.requester::<_, _, scl::codec::Json>(1)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.sensor, &self.calibrate]
    }
}

scl::private::component_methods!(Sensor);
scl::private::component_methods!(Controller);

const fn gate(name: &'static str, kind: GateKind, endpoint: &'static str, links: &'static [LinkSpec]) -> GateSpec {
    GateSpec {
        name,
        kind,
        payload: "any",
        codec: "json",
        place: "topology.yaml:5:5",
        endpoint,
        queue: 16,
        when_full: WhenFull::DropOldest,
        backpressure: false,
        timeout: Duration::from_secs(60),
        links,
    }
}

const fn link(peer_component: &'static str, peer_gate: &'static str, endpoint: &'static str) -> LinkSpec {
    LinkSpec {
        peer_component,
        peer_gate,
        endpoint,
        contract: "1a2b3c4d",
        required: true,
        queue: 16,
        when_full: WhenFull::DropOldest,
    }
}

#[tokio::test]
async fn components_meet_in_memory_and_touch_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let place = Memory::new();
    let options = OpenOptions::new().runtime_dir(folder.path()).transport(place.clone());
    let mut sensor = Sensor::open_with(options.clone()).await.unwrap();
    sensor.measurements.send(&vec![0.5]).await.unwrap();

    let mut controller = Controller::open_with(options).await.unwrap();
    controller.ready(Duration::from_secs(60)).await.unwrap();
    sensor.ready(Duration::from_secs(60)).await.unwrap();
    sensor.measurements.send(&vec![1.5, 2.5]).await.unwrap();
    assert_eq!(controller.sensor.recv().await.unwrap(), [0.5], "sent before anybody was there");
    assert_eq!(controller.sensor.recv().await.unwrap(), [1.5, 2.5]);

    let answering = async { sensor.calibrate.recv().await.unwrap().reply(&"done".to_owned()).await.unwrap() };
    let (answer, ()) = tokio::join!(controller.calibrate.call(&7), answering);
    assert_eq!(answer.unwrap(), "done");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "files in the runtime folder");
}

#[tokio::test]
async fn a_publisher_is_told_that_its_subscriber_came_and_went() {
    let place = Memory::new();
    let open_controller = || Controller::open_with(OpenOptions::new().transport(place.clone()));
    let mut sensor = Sensor::open_with(OpenOptions::new().transport(place.clone())).await.unwrap();
    for _ in 0..3 {
        let controller = open_controller().await.unwrap();
        // It comes while nobody waits for that, and goes while somebody does.
        sensor.ready(Duration::from_secs(60)).await.unwrap();
        assert_eq!(sensor.measurements.peers_changed().await, 1);
        let (peers, ()) = tokio::join!(sensor.measurements.peers_changed(), async { drop(controller) });
        assert_eq!(peers, 0);
        let nothing_new = pin!(sensor.measurements.peers_changed());
        assert!(nothing_new.poll(&mut Context::from_waker(Waker::noop())).is_pending());
    }
}

#[tokio::test]
async fn a_component_that_listens_is_opened_once_in_a_place() {
    let place = Memory::new();
    let open = || Sensor::open_with(OpenOptions::new().transport(place.clone()));
    let first = open().await.unwrap();
    let Err(error) = open().await else { panic!("opened twice") };
    assert_eq!(
        error.to_string(),
        format!(
            "gate `sensor.measurements` cannot be opened: the transport cannot open `{MEASUREMENTS}`: \
             another component of this program listens there; open each component once in a place"
        )
    );
    drop(first);
    open().await.unwrap();
    Sensor::open_with(OpenOptions::new().transport(Memory::new())).await.unwrap();
}

/// Two programs without async in one process: each component has a runtime of its own, and they meet all the same.
#[test]
fn components_of_two_threads_meet() {
    let place = Memory::new();
    let for_sensor = OpenOptions::new().transport(place.clone());
    let sensor = std::thread::spawn(move || {
        let mut sensor = Sensor::open_blocking_with(for_sensor).unwrap();
        for number in 0..100 {
            sensor.calibrate.recv_blocking().unwrap().reply_now(&number.to_string()).unwrap();
        }
    });
    let mut controller = Controller::open_blocking_with(OpenOptions::new().transport(place)).unwrap();
    for number in 0..100 {
        assert_eq!(controller.calibrate.call_blocking(&number).unwrap(), number.to_string());
    }
    sensor.join().unwrap();
}
