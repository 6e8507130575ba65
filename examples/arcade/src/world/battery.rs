//! A lithium-polymer battery of three cells with an internal resistance.

const CELLS: f64 = 3.0;
const RESISTANCE: f64 = 0.02; // Ohm
/// Voltage of a cell without load, at tenths of its charge from empty to full.
const VOLTAGE: [f64; 11] = [3.30, 3.61, 3.69, 3.71, 3.75, 3.80, 3.84, 3.91, 3.98, 4.08, 4.20];

/// Charge and present load.
#[derive(Clone, Copy, Debug)]
pub struct Battery {
    /// Ah.
    pub capacity: f64,
    /// Charge taken since it was full, Ah.
    pub used: f64,
    /// A.
    pub current: f64,
}

impl Battery {
    /// A battery of `capacity` Ah that is charged to `charge`, 0 to 1.
    pub fn new(capacity: f64, charge: f64) -> Self {
        Self { capacity, used: capacity * (1.0 - charge), current: 0.0 }
    }

    /// Charge that is left, 0 to 1.
    pub fn charge_left(&self) -> f64 {
        (1.0 - self.used / self.capacity).clamp(0.0, 1.0)
    }

    pub fn is_empty(&self) -> bool {
        self.used >= self.capacity
    }

    /// Voltage under the present load, V.
    pub fn voltage(&self) -> f64 {
        self.open_voltage() - RESISTANCE * self.current
    }

    fn open_voltage(&self) -> f64 {
        let place = self.charge_left() * 10.0;
        let below = (place.floor() as usize).min(9);
        CELLS * (VOLTAGE[below] + (VOLTAGE[below + 1] - VOLTAGE[below]) * (place - below as f64))
    }

    /// Draws `power` W for `elapsed` s. The current I follows from P = (U - R I) I.
    pub fn draw(&mut self, power: f64, elapsed: f64) {
        if self.is_empty() {
            self.current = 0.0;
            return;
        }
        let open = self.open_voltage();
        let under_root = (open * open - 4.0 * RESISTANCE * power).max(0.0);
        self.current = (open - under_root.sqrt()) / (2.0 * RESISTANCE);
        self.used += self.current * elapsed / 3600.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_load_gets_its_power_and_the_voltage_sags() {
        let mut battery = Battery::new(2.2, 1.0);
        battery.draw(140.0, 0.0);
        assert!((battery.voltage() * battery.current - 140.0).abs() < 1e-9, "{battery:?}");
        assert!((battery.voltage() - (12.6 - 0.02 * battery.current)).abs() < 1e-9);
    }

    #[test]
    fn hovering_lasts_about_ten_minutes() {
        let mut battery = Battery::new(2.2, 1.0);
        let seconds = (1..2000).find(|_| {
            battery.draw(138.0, 1.0);
            battery.is_empty()
        });
        assert!(seconds.is_some_and(|seconds| (600..720).contains(&seconds)), "{seconds:?}");
    }

    #[test]
    fn charge_is_counted() {
        let mut battery = Battery::new(2.0, 0.5);
        assert_eq!(battery.charge_left(), 0.5);
        battery.draw(100.0, 36.0);
        let expected = battery.current * 0.01;
        assert!((battery.used - 1.0 - expected).abs() < 1e-9, "{battery:?}");
    }
}
