//! Components on the transport within one process: the same gates, and no file anywhere.
#![allow(clippy::unwrap_used)]

use scl::OpenOptions;
use scl::transport::memory::Memory;
use std::pin::pin;
use std::task::{Context, Waker};
use std::time::Duration;

scl::topology!("memory_components.yaml");

type Values = Vec<f64>;

#[tokio::test]
async fn components_meet_in_memory_and_touch_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let memory = Memory::new();
    let options = OpenOptions::new().runtime_dir(folder.path()).transport(memory.clone());
    let mut sensor = Sensor::open_with(options.clone()).await.unwrap();
    sensor.measurements.send(&vec![0.5]).await.unwrap();

    let mut controller = Controller::open_with(options).await.unwrap();
    controller.ready(Duration::from_secs(300)).await.unwrap();
    sensor.ready(Duration::from_secs(300)).await.unwrap();
    sensor.measurements.send(&vec![1.5, 2.5]).await.unwrap();
    assert_eq!(controller.sensor.recv().await.unwrap(), [0.5], "sent before the peer was open");
    assert_eq!(controller.sensor.recv().await.unwrap(), [1.5, 2.5]);

    let answering = async { sensor.calibrate.recv().await.unwrap().reply(&"done".to_owned()).unwrap() };
    let (answer, ()) = tokio::join!(controller.calibrate.call(&7), answering);
    assert_eq!(answer.unwrap(), "done");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "files in the runtime folder");
}

#[tokio::test]
async fn a_publisher_is_told_that_its_subscriber_came_and_went() {
    let memory = Memory::new();
    let open_controller = || Controller::open_with(OpenOptions::new().transport(memory.clone()));
    let mut sensor = Sensor::open_with(OpenOptions::new().transport(memory.clone())).await.unwrap();
    for _ in 0..3 {
        let controller = open_controller().await.unwrap();
        // It connects while no call waits for that, and disconnects while one does.
        sensor.ready(Duration::from_secs(300)).await.unwrap();
        assert_eq!(sensor.measurements.peers_changed().await, 1);
        let (peers, ()) = tokio::join!(sensor.measurements.peers_changed(), async { drop(controller) });
        assert_eq!(peers, 0);
        let nothing_new = pin!(sensor.measurements.peers_changed());
        assert!(nothing_new.poll(&mut Context::from_waker(Waker::noop())).is_pending());
    }
}

#[tokio::test]
async fn a_component_that_listens_is_opened_once_in_a_memory() {
    let memory = Memory::new();
    let open = || Sensor::open_with(OpenOptions::new().transport(memory.clone()));
    let first = open().await.unwrap();
    let Err(error) = open().await else { panic!("opened twice") };
    let error = format!("{:?}", scl::Error::from(error));
    assert!(error.starts_with("gate `sensor.measurements` cannot be opened\n"), "{error}");
    assert!(error.contains("open each component once"), "{error}");
    drop(first);
    open().await.unwrap();
    Sensor::open_with(OpenOptions::new().transport(Memory::new())).await.unwrap();
}

/// Two programs without async in one process: each component has a runtime of its own, and they meet all the same.
#[test]
fn components_of_two_threads_meet() {
    let memory = Memory::new();
    let for_sensor = OpenOptions::new().transport(memory.clone());
    let sensor = std::thread::spawn(move || {
        let mut sensor = Sensor::open_blocking_with(for_sensor).unwrap();
        for number in 0..100 {
            sensor.calibrate.recv_blocking().unwrap().reply(&number.to_string()).unwrap();
        }
    });
    let mut controller = Controller::open_blocking_with(OpenOptions::new().transport(memory)).unwrap();
    for number in 0..100 {
        assert_eq!(controller.calibrate.call_blocking(&number).unwrap(), number.to_string());
    }
    sensor.join().unwrap();
}
