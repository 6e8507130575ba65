//! Plays components of `motors.yaml`: `motors controller`, which follows commands, or `motors`, the motor that
//! `SCL_COMPONENT` names. A motor that is ready says its name, and answers each setpoint with ten times its value; the
//! controller says which motor has answered.

use scl_tests::{Commands, say};
use std::time::Duration;

scl::topology!("topologies/motors.yaml");

const LONG: Duration = Duration::from_secs(300);

#[tokio::main(flavor = "current_thread")]
async fn main() -> scl::Result<()> {
    match std::env::args().nth(1).as_deref() {
        Some("controller") => play_controller(Controller::open().await?).await,
        _ => play_motor(Motor::open().await?).await,
    }
}

async fn play_motor(mut motor: Motor) -> scl::Result<()> {
    motor.ready(LONG).await?;
    say(motor.instance());
    loop {
        let setpoint = motor.setpoint.recv().await?;
        motor.state.send(&(10 * setpoint)).await?;
    }
}

async fn play_controller(mut controller: Controller) -> scl::Result<()> {
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        controller.ready(LONG).await?;
        let [side, value] = words.as_slice() else { continue };
        let value = value.parse().unwrap_or_default();
        match side.as_str() {
            "left" => controller.left.send(&value).await?,
            _ => controller.right.send(&value).await?,
        };
        let (motor, state) = controller.states.recv_from().await?;
        say(format!("{motor} {state}"));
    }
    Ok(())
}
