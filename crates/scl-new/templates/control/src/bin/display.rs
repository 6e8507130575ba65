//! Shows set-points and events, and asks for another speed every two seconds.

use std::time::Duration;

use scl::CallError;

use rover_system::Display;
use rover_system::rover::Command;

#[scl::main]
async fn main(mut display: Display) -> scl::Result<()> {
    let mut tick = scl::time::interval(Duration::from_secs(2))?;
    let mut target_speed = 0.5;
    loop {
        tokio::select! {
            setpoint = display.setpoints.recv() => println!("throttle {:+.2}", setpoint?.throttle),
            event = display.events.recv() => println!("event: {}", event?.text),
            ticked = tick.tick() => {
                ticked?;
                ask(&mut display, target_speed).await?;
                target_speed = 2.0 - target_speed;
            }
        }
    }
}

/// Asks the controller for a speed and shows its reply.
async fn ask(display: &mut Display, target_speed: f64) -> scl::Result<()> {
    let answer = match display.commands.call(&Command { target_speed }).await {
        Ok(status) if status.accepted => "accepted".to_owned(),
        Ok(status) => status.reason,
        // The controller is not running, or is being restarted.
        Err(CallError::Timeout { .. } | CallError::PeerLost { .. }) => "no answer".to_owned(),
        Err(error) => return Err(error.into()),
    };
    println!("asked for {target_speed:.1} m/s: {answer}");
    Ok(())
}
