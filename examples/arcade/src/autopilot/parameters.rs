//! What the autopilot flies by: its own parameters, and the limits that `configuration` tells all components.

use crate::arcade::Limits;
use crate::geodesy::Home;
use crate::{Autopilot, AutopilotParameters, Configuration};
use std::sync::LazyLock;

/// Declares the struct and how it is read from one list.
macro_rules! parameters {
    ($($field:ident)*) => {
        /// The values at one beat.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Parameters {
            $(pub $field: f64,)*
            /// All 0 until they are known.
            pub limits: Limits,
        }

        impl Parameters {
            /// The values that the autopilot's own parameters have now, and limits.
            pub fn new(own: &AutopilotParameters, limits: Limits) -> Self {
                Self { $($field: own.$field.get(),)* limits }
            }
        }
    };
}

parameters! {
    rate_p rate_i rate_d yaw_rate_p yaw_rate_i
    attitude_p yaw_p
    velocity_p velocity_i climb_p climb_i
    position_p height_p
    attitude_correction gyro_bias_correction position_correction velocity_correction bias_correction
    height_correction barometer_correction
    thrust_hover thrust_minimum thrust_maximum
    limit_tilt limit_acceleration limit_yaw_rate
    land_speed
}

impl Parameters {
    /// The defaults of the topology, for tests.
    ///
    /// # Panics
    /// Panics if a component cannot be opened for a test.
    pub fn defaults() -> Self {
        static DEFAULTS: LazyLock<Parameters> = LazyLock::new(|| {
            let (autopilot, _peer) = Autopilot::test_blocking().expect("opened");
            let (configuration, _peer) = Configuration::test_blocking().expect("opened");
            let known = &configuration.parameters;
            let limits = Limits {
                home_latitude: known.home_latitude.get(),
                home_longitude: known.home_longitude.get(),
                home_altitude: known.home_altitude.get(),
                fence_radius: known.fence_radius.get(),
                fence_height: known.fence_height.get(),
                speed: known.speed.get(),
                climb: known.climb.get(),
            };
            Parameters::new(&autopilot.parameters, limits)
        });
        *DEFAULTS
    }
}

impl Limits {
    /// Whether `configuration` has told them.
    pub fn are_known(&self) -> bool {
        self.fence_radius > 0.0
    }

    /// Where home is.
    pub fn home(&self) -> Home {
        Home { latitude: self.home_latitude, longitude: self.home_longitude, altitude: self.home_altitude }
    }
}
