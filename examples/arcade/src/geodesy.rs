//! Conversion between metres east and north of home, and degrees of latitude and longitude.
//!
//! A local tangent plane around home, with the earth's radii of curvature there (Groves, Principles of GNSS, Inertial
//! and Multisensor Integrated Navigation Systems, 2nd edition, equations 2.105, 2.106 and 2.111). Wrong by less than
//! 0.1 m within 1 km, and not for use at the poles.

const EQUATORIAL_RADIUS: f64 = 6378137.0; // m, WGS 84
const ECCENTRICITY_SQUARED: f64 = 6.69437999014e-3; // WGS 84
const RADIANS: f64 = std::f64::consts::PI / 180.0;

/// Where the vehicle stood at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Home {
    /// Degrees.
    pub latitude: f64,
    /// Degrees.
    pub longitude: f64,
    /// Metres above mean sea level.
    pub altitude: f64,
}

/// Degrees of latitude and longitude at a position in metres east and north of home.
pub fn to_degrees(home: Home, east: f64, north: f64) -> (f64, f64) {
    let (latitude, longitude) = metres_per_degree(home);
    (home.latitude + north / latitude, home.longitude + east / longitude)
}

/// Metres east and north of home at a position in degrees of latitude and longitude.
pub fn to_metres(home: Home, latitude: f64, longitude: f64) -> (f64, f64) {
    let metres = metres_per_degree(home);
    ((longitude - home.longitude) * metres.1, (latitude - home.latitude) * metres.0)
}

/// Metres per degree of latitude, and per degree of longitude.
fn metres_per_degree(home: Home) -> (f64, f64) {
    let sine = (home.latitude * RADIANS).sin();
    let flattened = 1.0 - ECCENTRICITY_SQUARED * sine * sine;
    let meridian = EQUATORIAL_RADIUS * (1.0 - ECCENTRICITY_SQUARED) / (flattened * flattened.sqrt());
    let transverse = EQUATORIAL_RADIUS / flattened.sqrt();
    let latitude = (meridian + home.altitude) * RADIANS;
    let longitude = (transverse + home.altitude) * (home.latitude * RADIANS).cos() * RADIANS;
    (latitude, longitude)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOME: Home = Home { latitude: 50.6866, longitude: 10.9190, altitude: 480.0 };

    #[test]
    fn a_degree_of_latitude_has_the_length_of_the_tables() {
        let home = Home { latitude: 45.0, longitude: 10.0, altitude: 0.0 };
        let (east, north) = to_metres(home, 46.0, 11.0);
        assert!((north - 111_131.7).abs() < 0.1, "{north}");
        assert!((east - 78_846.8).abs() < 0.1, "{east}");
    }

    #[test]
    fn there_and_back_again() {
        let (latitude, longitude) = to_degrees(HOME, 73.0, -41.0);
        let (east, north) = to_metres(HOME, latitude, longitude);
        assert!((east - 73.0).abs() < 1e-6 && (north + 41.0).abs() < 1e-6, "{east} {north}");
    }
}
