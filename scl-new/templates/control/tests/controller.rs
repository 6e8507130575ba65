//! The control loop beside the other ends of its gates: no processes, no sockets, and a clock that only waits move.

use std::time::Duration;

use tokio::time::{Instant, sleep};

use rover_system::controller::{self, SENSOR_TIMEOUT};
use rover_system::{Controller, ControllerPeer, rover};

/// The other ends of a running controller.
async fn start() -> ControllerPeer {
    let (controller, peer) = Controller::test().await.expect("opened");
    tokio::spawn(controller::run(controller));
    peer
}

#[tokio::test(start_paused = true)]
async fn a_slow_rover_gets_throttle() {
    let mut peer = start().await;
    peer.sensor.send(&rover::Measurement { speed: 0.25 }).await.expect("sent");
    assert_eq!(peer.setpoints.recv().await.expect("a set-point").throttle, 0.75);
}

#[tokio::test(start_paused = true)]
async fn a_command_changes_the_target() {
    let mut peer = start().await;
    let command = rover::Command { target_speed: 0.5 };
    assert!(peer.commands.call(&command).await.expect("a reply").accepted);
    assert_eq!(peer.events.recv().await.expect("an event").text, "target is now 0.5 m/s");
    peer.sensor.send(&rover::Measurement { speed: 0.5 }).await.expect("sent");
    assert_eq!(peer.setpoints.recv().await.expect("a set-point").throttle, 0.0);
}

#[tokio::test(start_paused = true)]
async fn an_impossible_speed_is_refused() {
    let mut peer = start().await;
    let status = peer.commands.call(&rover::Command { target_speed: 9.0 }).await.expect("a reply");
    assert!(!status.accepted);
    assert_eq!(status.reason, "not within 0 and 2 m/s");
}

#[tokio::test(start_paused = true)]
async fn without_measurements_the_motors_stop() {
    let mut peer = start().await;
    peer.sensor.send(&rover::Measurement { speed: 0.0 }).await.expect("sent");
    assert_eq!(peer.setpoints.recv().await.expect("a set-point").throttle, 1.0);

    // The sensor is silent. The clock is paused, so half a second passes at once.
    let silent_since = Instant::now();
    assert_eq!(peer.setpoints.recv().await.expect("a set-point").throttle, 0.0);
    assert_eq!(silent_since.elapsed(), SENSOR_TIMEOUT);

    sleep(Duration::from_secs(3600)).await;
    peer.sensor.send(&rover::Measurement { speed: 0.5 }).await.expect("sent");
    while peer.setpoints.recv().await.expect("a set-point").throttle != 0.5 {}
}
