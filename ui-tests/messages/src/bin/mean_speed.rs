//! A program whose component, messages and helper functions come from the library.

use scl_message_tests::{Controller, mean_speed, rover};

#[scl::main]
async fn main(mut controller: Controller) -> scl::Result<()> {
    let mut measurements: Vec<rover::Measurement> = Vec::new();
    loop {
        measurements.push(controller.sensor.recv().await?);
        println!("{} m/s, {:?}", mean_speed(&measurements), controller.temperature.try_recv()?);
    }
}
