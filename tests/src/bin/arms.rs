//! Plays components of `arms.yaml`: `arms pilot`, which follows commands, or `arms planner` and `arms driver` of the
//! arm that `SCL_COMPONENT` names. These say which they are when they are ready; the pilot says which driver has done
//! what.

use scl_tests::{Commands, say};
use std::time::Duration;

scl::topology!("topologies/arms.yaml");

const LONG: Duration = Duration::from_secs(300);

#[tokio::main(flavor = "current_thread")]
async fn main() -> scl::Result<()> {
    match std::env::args().nth(1).as_deref() {
        Some("pilot") => play_pilot(Pilot::open().await?).await,
        Some("planner") => play_planner(ArmPlanner::open().await?).await,
        _ => play_driver(ArmDriver::open().await?).await,
    }
}

async fn play_pilot(mut pilot: Pilot) -> scl::Result<()> {
    pilot.ready(LONG).await?;
    say("ready");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let [side, value] = words.as_slice() else { continue };
        let value = value.parse().unwrap_or_default();
        match side.as_str() {
            "left" => pilot.left.send(&value).await?,
            _ => pilot.right.send(&value).await?,
        };
        let (driver, done) = pilot.done.recv_from().await?;
        say(format!("{driver} {done}"));
    }
    Ok(())
}

async fn play_planner(mut planner: ArmPlanner) -> scl::Result<()> {
    planner.ready(LONG).await?;
    say(planner.instance());
    loop {
        let command = planner.commands.recv().await?;
        planner.steps.send(&(10 * command)).await?;
    }
}

async fn play_driver(mut driver: ArmDriver) -> scl::Result<()> {
    driver.ready(LONG).await?;
    say(driver.instance());
    loop {
        let step = driver.steps.recv().await?;
        driver.done.send(&(step + 1)).await?;
    }
}
