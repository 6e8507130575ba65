//! `scl info`: a gate, a component, and what does not exist.

use crate::rover::Rover;

#[test]
fn show() {
    let mut rover = Rover::start();
    for name in ["sensor", "sensor.measurements", "controller.sensor", "controller.commands", "user_interface.commands"]
    {
        eprintln!("{}", rover.text(&["info", name]));
    }
    eprintln!("{}", rover.text(&["list", "-v"]));
    rover.kill("sensor");
    eprintln!("{}", rover.text(&["info", "sensor.measurements"]));
    for name in ["sensr", "sensor.measurement", "sensor.sensor", "actuator", "x.y", ""] {
        eprintln!("{}", rover.error(&["info", name], 2));
    }
}
