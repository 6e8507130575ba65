//! One of the wheels: which one, `scl run` says.

use tracing::Level;

use rover_system::Wheel;
use rover_system::rover::Record;

#[scl::main]
async fn main(wheel: Wheel) -> scl::Result<()> {
    let component = wheel.instance().to_string();
    scl::events::send(wheel.log, Level::INFO, move |event| Record {
        component: component.clone(),
        text: event.text.clone(),
    })?;
    tracing::info!("runs");
    let response = wheel.parameters.response;
    rover_system::wheel::run(wheel.setpoint, wheel.state, response).await
}
