//! The world, the airframe, its sensors and its motors.

use arcade::Simulator;
use arcade::serial::SerialPort;
use arcade::simulation::Settings;
use arcade::simulator;
use clap::Parser;
use std::path::PathBuf;

/// Simulates a quadrotor in wind, in real time.
#[derive(Parser)]
struct Options {
    /// Mean wind from the west, m/s
    #[arg(long, default_value_t = 3.0, value_parser = not_negative, allow_negative_numbers = true)]
    wind: f64,
    /// Standard deviation of the gusts, m/s
    #[arg(long, default_value_t = 1.0, value_parser = not_negative, allow_negative_numbers = true)]
    gusts: f64,
    /// Seed of wind and noise: the same seed gives the same flight
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Capacity of the battery, Ah
    #[arg(long, default_value_t = 2.2, value_parser = positive, allow_negative_numbers = true)]
    battery: f64,
    /// Charge of the battery at the start, 0 to 1
    #[arg(long, default_value_t = 1.0, value_parser = share, allow_negative_numbers = true)]
    charge: f64,
    /// Speaks NMEA like a GPS receiver at a pseudo-terminal, with a symbolic link at this path
    #[arg(long, value_name = "PATH")]
    serial: Option<PathBuf>,
}

#[scl::main]
async fn main(simulator: Simulator) -> scl::Result<()> {
    let Options { wind, gusts, seed, battery, charge, serial } = Options::parse();
    let serial = serial.map(|path| SerialPort::open(&path)).transpose()?;
    println!(
        "wind {wind:.1} m/s with gusts of {gusts:.1} m/s, battery {battery:.2} Ah at {:.0} %, seed {seed}",
        charge * 100.0
    );
    simulator::run(simulator, Settings { wind, gusts, seed, capacity: battery, charge }, serial).await
}

fn number(text: &str, allowed: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    text.parse().ok().filter(|value: &f64| value.is_finite() && allowed(*value)).ok_or_else(|| expected.to_owned())
}

fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |value| value >= 0.0, "expected a number that is not negative")
}

fn positive(text: &str) -> Result<f64, String> {
    number(text, |value| value > 0.0, "expected a number greater than 0")
}

fn share(text: &str) -> Result<f64, String> {
    number(text, |value| (0.0..=1.0).contains(&value), "expected a number from 0 to 1")
}
