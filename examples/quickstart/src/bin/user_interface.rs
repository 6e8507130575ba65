//! Asks for another speed every second and shows what happens.

use scl::CallError;
use std::time::Duration;

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut ui: UserInterface) -> scl::Result<()> {
    let mut tick = scl::time::interval(Duration::from_secs(1))?;
    for target_speed in [0.5, 1.5].into_iter().cycle() {
        tick.tick().await?;
        let status = match ui.commands.call(&rover::Command { target_speed }).await {
            Ok(status) => status,
            // The controller is not running, or is being replaced.
            Err(CallError::Timeout { .. } | CallError::PeerLost { .. }) => {
                println!("asked for {target_speed:.1} m/s: no answer");
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        println!("asked for {target_speed:.1} m/s: {}", if status.accepted { "accepted" } else { &status.reason });
        println!("event: {}", ui.events.recv().await?.text);
    }
    Ok(())
}
