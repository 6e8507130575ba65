//! Shows each measurement.

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut display: Display) -> scl::Result<()> {
    loop {
        println!("{}", line(&display.sensor.recv_blocking()?));
    }
}

fn line(measurement: &rover::Measurement) -> String {
    format!("speed {:.2} m/s", measurement.speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measurement_becomes_a_line() {
        let (mut display, mut peer) = Display::test_blocking().expect("opened");
        peer.sensor.send_blocking(&rover::Measurement { speed: 1.5 }).expect("sent");
        let measurement = display.sensor.recv_blocking().expect("received");
        assert_eq!(line(&measurement), "speed 1.50 m/s");
    }
}
