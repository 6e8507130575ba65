//! Messages recorded and lost per gate, as the metadata record at the end of a recording.

use std::collections::BTreeMap;

/// Metadata record with the name [`Totals::NAME`]. It is written last, so a recording that was cut off has none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Totals {
    /// Key `system`: the system's name.
    pub system: String,
    /// Totals by gate (`sensor.measurements`). Keys `<gate>.recorded`, `<gate>.lost` and, unless it is 0,
    /// `<gate>.latched`.
    pub gates: BTreeMap<String, GateTotals>,
}

/// Messages of one gate; requests and replies together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GateTotals {
    /// Messages in this file.
    pub recorded: u64,
    /// Messages that the gate sent while this file was written, but that are not in it.
    pub lost: u64,
    /// Recorded messages that were sent before the recorder observed the gate: the last message of a gate with
    /// `latched: true`.
    pub latched: u64,
}

impl Totals {
    /// Name of the metadata record.
    pub const NAME: &'static str = "scl";

    /// Returns the totals as the map in the file.
    pub fn to_map(&self) -> BTreeMap<String, String> {
        let mut map = BTreeMap::from([(SYSTEM.to_owned(), self.system.clone())]);
        for (gate, totals) in &self.gates {
            map.insert(format!("{gate}{RECORDED}"), totals.recorded.to_string());
            map.insert(format!("{gate}{LOST}"), totals.lost.to_string());
            if totals.latched > 0 {
                map.insert(format!("{gate}{LATCHED}"), totals.latched.to_string());
            }
        }
        map
    }

    /// Reads the map; `None` if it is not of this form.
    pub fn from_map(map: &BTreeMap<String, String>) -> Option<Self> {
        let mut totals = Self { system: map.get(SYSTEM)?.clone(), gates: BTreeMap::new() };
        for (key, value) in map {
            if let Some(gate) = key.strip_suffix(RECORDED) {
                totals.gates.entry(gate.to_owned()).or_default().recorded = value.parse().ok()?;
            } else if let Some(gate) = key.strip_suffix(LOST) {
                totals.gates.entry(gate.to_owned()).or_default().lost = value.parse().ok()?;
            } else if let Some(gate) = key.strip_suffix(LATCHED) {
                totals.gates.entry(gate.to_owned()).or_default().latched = value.parse().ok()?;
            }
        }
        Some(totals)
    }
}

const SYSTEM: &str = "system";
const RECORDED: &str = ".recorded";
const LOST: &str = ".lost";
const LATCHED: &str = ".latched";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_are_read_as_they_are_written() {
        let gates = BTreeMap::from([
            ("sensor.lost".to_owned(), GateTotals { recorded: 5, lost: 1, latched: 1 }),
            ("sensor.measurements".to_owned(), GateTotals { recorded: u64::MAX, lost: 0, latched: 0 }),
        ]);
        let totals = Totals { system: "rover".to_owned(), gates };
        assert_eq!(Totals::from_map(&totals.to_map()), Some(totals));
        assert_eq!(Totals::from_map(&BTreeMap::new()), None);
    }
}
