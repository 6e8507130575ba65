//! A wheel beside the other ends of its gates: no processes, no sockets.

use rover_system::rover::Setpoint;
use rover_system::{Wheel, WheelPeer, wheel};

/// Runs a wheel and returns the other ends of its gates.
async fn start() -> scl::Result<WheelPeer> {
    let (wheel, peer) = Wheel::test().await?;
    let response = wheel.parameters.response;
    tokio::spawn(wheel::run(wheel.setpoint, wheel.state, response));
    Ok(peer)
}

#[tokio::test]
async fn a_wheel_follows_set_points_and_stops_without_them() -> scl::Result<()> {
    let mut peer = start().await?;
    while peer.state.recv().await?.speed < 0.9 {
        peer.setpoint.send(&Setpoint { speed: 1.0 }).await?;
    }
    while peer.state.recv().await?.speed > 0.1 {}
    Ok(())
}
