//! Plays a component of the paper's Listing 1, whose messages are plain bytes: `listing1 sensor` and so on.

use scl::bytes::Bytes;
use scl_tests::say;

scl::topology!("topologies/listing1.yaml");

#[tokio::main(flavor = "current_thread")]
async fn main() -> scl::Result<()> {
    match std::env::args().nth(1).unwrap_or_default().as_str() {
        "sensor" => sensor(Sensor::open().await?).await,
        "actuator" => actuator(Actuator::open().await?).await,
        "controller" => controller(Controller::open().await?).await,
        _ => user_interface(UserInterface::open().await?).await,
    }
}

/// Sends one measurement and waits to be killed. One is enough, because the first message is not lost.
async fn sensor(mut sensor: Sensor) -> scl::Result<()> {
    sensor.measurements.send(&Bytes::from_static(b"measured")).await?;
    say("sent");
    std::future::pending().await
}

async fn actuator(mut actuator: Actuator) -> scl::Result<()> {
    loop {
        say(format!("set to {:?}", actuator.setpoint.recv().await?));
    }
}

async fn controller(mut c: Controller) -> scl::Result<()> {
    loop {
        tokio::select! {
            measurement = c.sensor.recv() => c.actuator.send(&measurement?).await?,
            command = c.commands.recv() => {
                let command = command?;
                c.events.send(command.message()).await?;
                command.reply(&Bytes::from_static(b"done"))?;
            }
        }
    }
}

async fn user_interface(mut ui: UserInterface) -> scl::Result<()> {
    let status = ui.commands.call(&Bytes::from_static(b"faster")).await?;
    say(format!("status {status:?}, event {:?}", ui.events.recv().await?));
    Ok(())
}
