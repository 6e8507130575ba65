//! Drives while all wheels report, and stops them when one does not.

use drive::{Record, Setpoint};
use std::collections::HashMap;
use std::time::Duration;
use tracing::Level;

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut chassis: Chassis) -> scl::Result<()> {
    let record = |event: &scl::events::Event| Record { component: "chassis".to_owned(), text: event.text.clone() };
    scl::events::send(chassis.log, Level::INFO, record)?;

    let mut tick = scl::time::interval(Duration::from_millis(50))?;
    // The wheels that have reported since one was missing, with the languages of their programs.
    let mut wheels = HashMap::new();
    let mut drives = false;
    loop {
        tokio::select! {
            missed = chassis.states.deadline_missed() => {
                missed?;
                if std::mem::take(&mut drives) {
                    tracing::info!("stops: a wheel does not report");
                }
                wheels.clear();
            }
            state = chassis.states.recv_from() => {
                let (wheel, state) = state?;
                wheels.insert(wheel, state.language);
                if !drives && wheels.len() == WheelInstance::ALL.len() {
                    drives = true;
                    let languages = WheelInstance::ALL.iter().map(|wheel| format!("{wheel} in {}", wheels[wheel]));
                    tracing::info!("drives: {}", languages.collect::<Vec<_>>().join(", "));
                }
            }
            ticked = tick.tick() => {
                ticked?;
                let speed = if drives { chassis.parameters.speed.get() } else { 0.0 };
                chassis.wheels.send(&Setpoint { speed }).await?;
            }
        }
    }
}
