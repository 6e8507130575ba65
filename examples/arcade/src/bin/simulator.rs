//! The world, the airframe, its sensors and its motors.

use arcade::serial::SerialPort;
use arcade::{Simulator, simulator};
use clap::Parser;
use std::path::PathBuf;

/// Simulates a quadrotor in wind, in real time.
#[derive(Parser)]
struct Options {
    /// Speaks NMEA like a GPS receiver at a pseudo-terminal, with a symbolic link at this path
    #[arg(long, value_name = "PATH")]
    serial: Option<PathBuf>,
}

#[scl::main]
async fn main(simulator: Simulator) -> scl::Result<()> {
    let Options { serial } = Options::parse();
    let serial = serial.map(|path| SerialPort::open(&path)).transpose()?;
    let parameters = &simulator.parameters;
    println!(
        "wind {:.1} m/s with gusts of {:.1} m/s, battery {:.2} Ah at {:.0} %, seed {}",
        parameters.wind,
        parameters.gusts,
        parameters.capacity,
        parameters.charge * 100.0,
        parameters.seed
    );
    simulator::run(simulator, serial).await
}
