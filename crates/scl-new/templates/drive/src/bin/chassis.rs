//! Drives while all wheels report, and stops them when one does not.

use tracing::Level;

use rover_system::Chassis;
use rover_system::rover::Record;

#[scl::main]
async fn main(chassis: Chassis) -> scl::Result<()> {
    scl::events::send(chassis.log, Level::INFO, |event| Record {
        component: "chassis".to_owned(),
        text: event.text.clone(),
    })?;
    let speed = chassis.parameters.speed;
    rover_system::chassis::run(chassis.wheels, chassis.states, speed).await
}
