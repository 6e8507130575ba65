//! Components, gates, requests and errors can be sent to other threads and shared between them.

use scl::{
    BlockingError, CallError, Error, GateStats, NotFlushed, NotReady, OpenError, OpenOptions, PeerStats, Pub, Pull,
    Push, RecvError, RecvTimeoutError, Rep, ReplyError, Req, Request, SendError, SendTimeoutError, Sub, TrySendError,
    untyped,
};
use std::time::Duration;

scl::topology!("memory_components.yaml");

type Values = Vec<f64>;

fn assert_send_sync<T: Send + Sync>() {}
fn assert_send(_: &impl Send) {}

#[test]
fn everything_of_a_component_is_send_and_sync() {
    assert_send_sync::<Sensor>();
    assert_send_sync::<Controller>();
    assert_send_sync::<(Pub<String>, Sub<String>, Push<String>, Pull<String>)>();
    assert_send_sync::<(Req<u32, String>, Rep<u32, String>, Request<u32, String>)>();
    assert_send_sync::<(OpenOptions, GateStats, PeerStats)>();
    assert_send_sync::<(OpenError, BlockingError, SendError, TrySendError, RecvError, RecvTimeoutError)>();
    assert_send_sync::<(CallError, ReplyError, NotReady, NotFlushed, Error, SendTimeoutError)>();
    assert_send_sync::<(untyped::Component, untyped::Gate, untyped::Closer, untyped::Readiness, untyped::WaitError)>();
}

#[tokio::test]
async fn every_waiting_call_can_be_awaited_in_a_spawned_task() {
    let options = || OpenOptions::new().transport(scl::transport::memory::Memory::new());
    let mut sensor = Sensor::open_with(options()).await.expect("opened");
    let mut controller = Controller::open_with(options()).await.expect("opened");
    assert_send(&Sensor::open());
    assert_send(&sensor.ready(Duration::ZERO));
    assert_send(&sensor.measurements.send(&Vec::new()));
    assert_send(&sensor.measurements.peers_changed());
    assert_send(&sensor.calibrate.recv());
    assert_send(&controller.sensor.recv());
    assert_send(&controller.calibrate.call(&7));
    assert_send(&controller.calibrate.call_within(&7, Duration::ZERO));
    assert_send(&controller.close(Duration::ZERO));
    assert_send(&scl::stop_requested());
}
