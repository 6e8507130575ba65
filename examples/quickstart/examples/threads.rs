//! A controller without async whose gates are used in separate threads.

use std::thread;

scl::topology!("topology.yaml");

#[scl::main]
fn main(c: Controller) -> scl::Result<()> {
    let Controller { mut sensor, mut actuator, mut commands, .. } = c;
    let steering = thread::spawn(move || -> scl::Result<()> {
        loop {
            let throttle = 1.0 - sensor.recv_blocking()?.speed;
            actuator.send_blocking(&rover::Setpoint { throttle })?;
        }
    });
    let commanding = thread::spawn(move || -> scl::Result<()> {
        loop {
            let command = commands.recv_blocking()?;
            command.reply(&rover::Status { accepted: false, reason: "not while steering".to_owned() })?;
        }
    });
    for thread in [steering, commanding] {
        thread.join().expect("no panic")?;
    }
    Ok(())
}
