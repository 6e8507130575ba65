//! Sentences of NMEA 0183, as a GPS receiver at a serial port sends them.

use crate::arcade::Fix;

const KNOTS: f64 = 1.943_844; // for 1 m/s
/// The day on which the vehicle's clock starts, at midnight UTC: day, month, year.
const DATE: &str = "010113";

/// The sentences for one fix, GGA and RMC.
pub fn sentences(fix: &Fix) -> String {
    format!("{}{}", sentence(&gga(fix)), sentence(&rmc(fix)))
}

/// Global positioning system fix data.
fn gga(fix: &Fix) -> String {
    let (time, place) = (time(fix.time_us), place(fix));
    format!("GPGGA,{time},{place},1,{:02},0.9,{:.1},M,0.0,M,,", fix.satellites, fix.altitude)
}

/// Recommended minimum data.
fn rmc(fix: &Fix) -> String {
    let (time, place) = (time(fix.time_us), place(fix));
    let knots = fix.east_speed.hypot(fix.north_speed) * KNOTS;
    // Clockwise from north. Rounding to 360.00 would be out of range.
    let course = fix.east_speed.atan2(fix.north_speed).to_degrees().rem_euclid(360.0);
    let course = if course >= 359.995 { 0.0 } else { course };
    format!("GPRMC,{time},A,{place},{knots:.2},{course:.2},{DATE},,,A")
}

/// Makes a sentence: `$`, the text, and the exclusive or of its bytes.
fn sentence(text: &str) -> String {
    let checksum = text.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("${text}*{checksum:02X}\r\n")
}

/// Formats a time as hhmmss.ss.
fn time(time_us: u64) -> String {
    let hundredths = time_us / 10_000;
    let seconds = hundredths / 100;
    let (hours, minutes) = (seconds / 3600 % 24, seconds / 60 % 60);
    format!("{hours:02}{minutes:02}{:02}.{:02}", seconds % 60, hundredths % 100)
}

fn place(fix: &Fix) -> String {
    let north = if fix.latitude < 0.0 { 'S' } else { 'N' };
    let east = if fix.longitude < 0.0 { 'W' } else { 'E' };
    format!("{},{north},{},{east}", degrees_and_minutes(fix.latitude, 2), degrees_and_minutes(fix.longitude, 3))
}

/// Degrees with `digits` digits, then minutes with five decimals, which resolve 2 cm.
fn degrees_and_minutes(degrees: f64, digits: usize) -> String {
    // Round degrees and minutes together, so 59.999999 minutes carry over into the next degree.
    let units = (degrees.abs() * 6_000_000.0).round() as u64; // minutes / 100000
    let (degrees, minutes) = (units / 6_000_000, units % 6_000_000);
    format!("{degrees:0digits$}{:02}.{:05}", minutes / 100_000, minutes % 100_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIX: Fix = Fix {
        time_us: 3_723_400_000,
        quality: 2,
        latitude: 50.6866,
        longitude: -10.919,
        altitude: 485.26,
        east_speed: -1.0,
        north_speed: 0.0,
        satellites: 10,
    };

    #[test]
    fn sentences_are_those_of_the_standard() {
        let expected = "$GPGGA,010203.40,5041.19600,N,01055.14000,W,1,10,0.9,485.3,M,0.0,M,,*";
        let (gga, rmc) = (sentence(&gga(&FIX)), sentence(&rmc(&FIX)));
        assert!(gga.starts_with(expected), "{gga}");
        assert!(rmc.starts_with("$GPRMC,010203.40,A,5041.19600,N,01055.14000,W,1.94,270.00,010113,,,A*"), "{rmc}");
    }

    #[test]
    fn the_checksum_is_that_of_a_known_sentence() {
        let text = "GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,";
        assert_eq!(sentence(text), format!("${text}*47\r\n"));
    }

    #[test]
    fn minutes_are_never_sixty() {
        assert_eq!(degrees_and_minutes(10.999_999_999, 3), "01100.00000");
    }
}
