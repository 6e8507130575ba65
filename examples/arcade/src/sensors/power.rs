//! The battery's sensor: voltage, current and a charge counter.

use crate::arcade;
use crate::world::battery::Battery;
use crate::world::noise::Noise;

const VOLTAGE_NOISE: f64 = 0.02; // V
const CURRENT_NOISE: f64 = 0.1; // A

/// The sensor's errors.
#[derive(Debug)]
pub struct PowerSensor {
    noise: Noise,
}

impl PowerSensor {
    pub fn new(seed: u64) -> Self {
        Self { noise: Noise::new(seed, "power") }
    }

    pub fn measure(&mut self, time_us: u64, battery: &Battery) -> arcade::Battery {
        arcade::Battery {
            time_us,
            voltage: battery.voltage() + self.noise.normal(VOLTAGE_NOISE),
            current: (battery.current + self.noise.normal(CURRENT_NOISE)).max(0.0),
            used: battery.used,
            capacity: battery.capacity,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_those_of_the_battery() {
        let mut battery = Battery::new(2.2, 0.5);
        battery.draw(140.0, 1.0);
        let reading = PowerSensor::new(1).measure(7, &battery);
        assert!((reading.voltage - battery.voltage()).abs() < 0.1, "{reading:?}");
        assert!((reading.current - battery.current).abs() < 0.5, "{reading:?}");
        assert_eq!((reading.time_us, reading.used, reading.capacity), (7, battery.used, 2.2));
    }
}
