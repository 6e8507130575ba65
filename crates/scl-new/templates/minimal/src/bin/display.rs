//! Shows each measurement.

use rover::Measurement;

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut display: Display) -> scl::Result<()> {
    loop {
        println!("{}", line(&display.sensor.recv_blocking()?));
    }
}

fn line(measurement: &Measurement) -> String {
    format!("speed {:.2} m/s", measurement.speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measurement_becomes_a_line() {
        let (mut display, mut peer) = Display::test_blocking().expect("opened");
        let sent = Measurement { speed: 1.5 };
        peer.sensor.send_blocking(&sent).expect("sent");
        let measurement = display.sensor.recv_blocking().expect("received");
        assert_eq!(line(&measurement), "speed 1.50 m/s");
    }
}
