//! The control loop beside the other ends of its gates: no processes, no sockets, a paused clock.

use tokio::time::Instant;

use rover_system::rover::{Command, Measurement};

use rover_system::controller::{SENSOR_TIMEOUT, run};
use rover_system::{Controller, ControllerPeer};

/// Runs a controller and returns the other ends of its gates.
async fn start() -> scl::Result<ControllerPeer> {
    let (controller, peer) = Controller::test().await?;
    tokio::spawn(run(controller));
    Ok(peer)
}

#[tokio::test(start_paused = true)]
async fn a_slow_vehicle_gets_throttle() -> scl::Result<()> {
    let mut peer = start().await?;
    peer.sensor.send(&Measurement { speed: 0.25 }).await?;
    assert_eq!(peer.setpoints.recv().await?.throttle, 0.75);
    Ok(())
}

#[tokio::test(start_paused = true)]
async fn a_command_changes_the_target() -> scl::Result<()> {
    let mut peer = start().await?;
    let status = peer.commands.call(&Command { target_speed: 0.5 }).await?;
    assert!(status.accepted);
    assert_eq!(peer.events.recv().await?.text, "target is now 0.5 m/s");

    peer.sensor.send(&Measurement { speed: 0.5 }).await?;
    assert_eq!(peer.setpoints.recv().await?.throttle, 0.0);
    Ok(())
}

#[tokio::test(start_paused = true)]
async fn an_impossible_speed_is_refused() -> scl::Result<()> {
    let mut peer = start().await?;
    let status = peer.commands.call(&Command { target_speed: 9.0 }).await?;
    assert!(!status.accepted);
    assert_eq!(status.reason, "not between 0 and 2 m/s");
    Ok(())
}

#[tokio::test(start_paused = true)]
async fn without_measurements_the_motors_stop() -> scl::Result<()> {
    let mut peer = start().await?;
    peer.sensor.send(&Measurement { speed: 0.0 }).await?;
    assert_eq!(peer.setpoints.recv().await?.throttle, 1.0);

    // While all tasks wait, the paused clock jumps to the next timeout: half a second takes no time.
    let silent_since = Instant::now();
    assert_eq!(peer.setpoints.recv().await?.throttle, 0.0);
    assert_eq!(silent_since.elapsed(), SENSOR_TIMEOUT);
    Ok(())
}
