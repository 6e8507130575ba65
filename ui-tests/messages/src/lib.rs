//! The topology of a system with the messages of all its programs, and functions that take messages.

/// Messages of our own, which only Rust programs read.
pub mod weather {
    /// What the thermometer shows.
    #[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
    pub struct Temperature {
        /// In degrees Celsius.
        pub celsius: f32,
    }
}

scl::topology!("topology.yaml", testable = true);

/// The mean speed of some measurements.
pub fn mean_speed(measurements: &[rover::Measurement]) -> f64 {
    measurements.iter().map(|it| it.speed).sum::<f64>() / measurements.len() as f64
}
