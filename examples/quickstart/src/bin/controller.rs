//! Steers towards the speed that the user interface asks for.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    let mut target_speed = 1.0;
    loop {
        tokio::select! {
            measured = c.sensor.recv() => {
                let throttle = (target_speed - measured?.speed).clamp(-1.0, 1.0);
                c.actuator.send(&rover::Setpoint { throttle }).await?;
            }
            command = c.commands.recv() => {
                let command = command?;
                target_speed = command.target_speed;
                c.events.send(&rover::Event { text: format!("target is now {target_speed:.1} m/s") }).await?;
                // A user interface that has been stopped no longer waits for the reply.
                let _gone = command.reply(&rover::Status { accepted: true, reason: String::new() });
            }
        }
    }
}
