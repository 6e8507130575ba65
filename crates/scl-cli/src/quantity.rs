//! Quantities as text of few characters: `99.95ms`, `1.000kHz`. Tables have no room for more.

/// Formats a duration in nanoseconds, which may be negative.
pub(crate) fn duration(nanoseconds: f64) -> String {
    match nanoseconds.abs() {
        ns if ns < 999.95 => format!("{nanoseconds:.0}ns"),
        ns if ns < 999.95e3 => scaled(nanoseconds / 1e3, "us"),
        ns if ns < 999.95e6 => scaled(nanoseconds / 1e6, "ms"),
        _ => scaled(nanoseconds / 1e9, "s"),
    }
}

/// A number of events per second.
pub(crate) fn frequency(hertz: f64) -> String {
    match hertz {
        hertz if hertz < 999.95 => scaled(hertz, "Hz"),
        hertz if hertz < 999.95e3 => scaled(hertz / 1e3, "kHz"),
        hertz => scaled(hertz / 1e6, "MHz"),
    }
}

/// Four digits and a unit.
fn scaled(value: f64, unit: &str) -> String {
    let decimals = match value.abs() {
        value if value < 9.9995 => 3,
        value if value < 99.995 => 2,
        value if value < 999.95 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}{unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_have_four_digits_and_the_unit_that_fits() {
        for (nanoseconds, expected) in [
            (0.0, "0ns"),
            (999.0, "999ns"),
            (999.96, "1.000us"),
            (-52_340.0, "-52.34us"),
            (99_953_000.0, "99.95ms"),
            (99_996_000.0, "100.0ms"),
            (999_960_000.0, "1.000s"),
            (86_400e9, "86400s"),
        ] {
            assert_eq!(duration(nanoseconds), expected);
        }
        for (hertz, expected) in [(0.0, "0.000Hz"), (9.9999, "10.00Hz"), (1000.0, "1.000kHz"), (2.5e6, "2.500MHz")] {
            assert_eq!(frequency(hertz), expected);
        }
    }
}
