//! The values that can be changed while the program runs, with their defaults.
//!
//! `configuration` keeps them for all programs and has the same defaults; the autopilot flies without it.

use crate::geodesy::Home;

/// Declares the struct, its defaults and the table of names from one list.
macro_rules! parameters {
    ($($field:ident: $name:literal = $default:literal,)*) => {
        /// The parameters of the autopilot.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Parameters {
            $(pub $field: f64,)*
        }

        /// Names and defaults, in the order of [`Parameters::values`].
        pub const TABLE: &[(&str, f64)] = &[$(($name, $default),)*];

        impl Default for Parameters {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl Parameters {
            /// Sets the parameter `name` if the autopilot has it. A value that is not a number is ignored.
            pub fn set(&mut self, name: &str, value: f64) {
                match name {
                    _ if !value.is_finite() => {}
                    $($name => self.$field = value,)*
                    _ => {}
                }
            }

            /// All values.
            pub fn values(&self) -> [f64; TABLE.len()] {
                [$(self.$field,)*]
            }

            /// From all values.
            pub fn from_values(values: &[f64; TABLE.len()]) -> Self {
                let [$($field,)*] = *values;
                Self { $($field,)* }
            }
        }
    };
}

parameters! {
    // Angular rates to torque: difference of motor set-points per rad/s, per its integral and per its derivative.
    rate_p: "rate.roll_pitch.p" = 0.06,
    rate_i: "rate.roll_pitch.i" = 0.1,
    rate_d: "rate.roll_pitch.d" = 0.001,
    yaw_rate_p: "rate.yaw.p" = 0.15,
    yaw_rate_i: "rate.yaw.i" = 0.1,
    // Attitude to angular rates: rad/s per rad.
    attitude_p: "attitude.p" = 6.0,
    yaw_p: "attitude.yaw.p" = 2.0,
    // Velocity to acceleration, horizontal and vertical: m/s^2 per m/s, and per metre of its integral.
    velocity_p: "velocity.p" = 2.5,
    velocity_i: "velocity.i" = 0.8,
    climb_p: "climb.p" = 4.0,
    climb_i: "climb.i" = 2.0,
    // Position to velocity: m/s per metre.
    position_p: "position.p" = 1.0,
    height_p: "height.p" = 1.5,
    // Estimation: how fast each correction acts, in 1/s, and each integral, in 1/s^2.
    attitude_correction: "estimation.attitude.p" = 2.0,
    gyro_bias_correction: "estimation.attitude.i" = 0.2,
    position_correction: "estimation.position.p" = 0.5,
    velocity_correction: "estimation.velocity.p" = 0.8,
    bias_correction: "estimation.velocity.i" = 0.1,
    height_correction: "estimation.height.bandwidth" = 2.5,
    barometer_correction: "estimation.barometer.p" = 0.3,
    // Thrust of each motor, 0 to 1.
    thrust_hover: "thrust.hover" = 0.45,
    thrust_minimum: "thrust.minimum" = 0.1,
    thrust_maximum: "thrust.maximum" = 0.9,
    limit_tilt: "limit.tilt" = 25.0,                 // degrees
    limit_speed: "limit.speed" = 4.0,                // m/s
    limit_climb: "limit.climb" = 1.5,                // m/s, up and down
    limit_acceleration: "limit.acceleration" = 1.5,  // m/s^2
    limit_yaw_rate: "limit.yaw_rate" = 60.0,         // degrees/s
    land_speed: "land.speed" = 0.5,                  // m/s, in the last metres
    fence_radius: "fence.radius" = 100.0,            // m from home
    fence_height: "fence.height" = 30.0,             // m above home
    home_latitude: "home.latitude" = 50.6866,        // degrees
    home_longitude: "home.longitude" = 10.9190,      // degrees
    home_altitude: "home.altitude" = 480.0,          // m above mean sea level
}

impl Parameters {
    pub fn home(&self) -> Home {
        Home { latitude: self.home_latitude, longitude: self.home_longitude, altitude: self.home_altitude }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_defaults_are_those_of_the_table() {
        let mut names: Vec<_> = TABLE.iter().map(|(name, _)| name).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), TABLE.len());
        assert!(TABLE.iter().map(|(_, value)| *value).eq(Parameters::default().values()));
    }

    #[test]
    fn each_name_sets_its_own_value() {
        for (index, (name, _)) in TABLE.iter().enumerate() {
            let mut parameters = Parameters::default();
            parameters.set(name, 12345.0);
            let changed: Vec<_> = parameters.values().iter().map(|value| *value == 12345.0).collect();
            assert_eq!(changed.iter().position(|changed| *changed), Some(index));
            assert_eq!(changed.iter().filter(|changed| **changed).count(), 1);
            assert_eq!(Parameters::from_values(&parameters.values()), parameters);
        }
    }

    #[test]
    fn unknown_names_and_values_that_are_no_numbers_are_ignored() {
        let mut parameters = Parameters::default();
        parameters.set("power.low", 0.5);
        parameters.set("attitude.p", f64::NAN);
        assert_eq!(parameters, Parameters::default());
    }
}
