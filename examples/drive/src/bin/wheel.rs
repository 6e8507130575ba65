//! A wheel: it follows the set-point, and stops when none comes.

use drive::{Record, WheelState};
use std::time::Duration;
use tracing::Level;

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut wheel: Wheel) -> scl::Result<()> {
    let component = wheel.instance().to_string();
    let record = move |event: &scl::events::Event| Record { component: component.clone(), text: event.text.clone() };
    scl::events::send(wheel.log, Level::INFO, record)?;
    tracing::info!("runs in Rust");

    let mut tick = scl::time::interval(Duration::from_millis(50))?;
    let (mut target, mut speed) = (0.0, 0.0);
    loop {
        tokio::select! {
            missed = wheel.setpoint.deadline_missed() => {
                missed?;
                target = 0.0;
            }
            setpoint = wheel.setpoint.recv() => target = setpoint?.speed,
            ticked = tick.tick() => {
                ticked?;
                speed += (target - speed) * wheel.parameters.response;
                wheel.state.send(&WheelState { speed, language: "Rust".to_owned() }).await?;
            }
        }
    }
}
