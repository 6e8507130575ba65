//! The program `simulator`: paces the simulation in real time and closes the loop over its gates.

use crate::Simulator;
use crate::arcade;
use crate::geodesy::Home;
use crate::nmea;
use crate::sensors::gps::{self, Receiver};
use crate::sensors::truth;
use crate::serial::SerialPort;
use crate::simulation::{RATE, Readings, Settings, Simulation};
use crate::watch::Watch;
use std::time::Duration;

/// Maximum number of missed steps that are made up for, 20 ms. After a longer interruption the simulation continues
/// from there: many steps at once would be a flight without control.
const MAX_MISSED: u64 = 6;
/// How long to wait for the other components before time begins without those that are missing.
const PATIENCE: Duration = Duration::from_secs(20);
const NMEA_PERIOD: u64 = (RATE / gps::RATE) as u64; // steps

/// Runs the simulation until the program is stopped.
///
/// # Errors
/// Errors of the gates, the timer and the serial port.
pub async fn run(mut gates: Simulator, serial: Option<SerialPort>) -> scl::Result<()> {
    let settings = Settings::new(&gates.parameters);
    let mut simulation = Simulation::new(&settings);
    let mut receiver = SerialReceiver { port: serial, receiver: Receiver::new(settings.seed), home: None };
    let mut watch = Watch::default();
    if let Err(missing) = gates.ready(PATIENCE).await {
        println!("starting without all components: {missing}");
    }
    let mut tick = scl::time::interval(Duration::from_secs(1) / RATE)?;
    loop {
        tick.tick().await?;
        let missed = tick.skip_missed();
        if missed > MAX_MISSED {
            println!("the simulation stood still for {} ms", missed * 1000 / u64::from(RATE));
        }
        let steps = if missed > MAX_MISSED { 1 } else { 1 + missed };
        for _ in 0..steps {
            if let Some(limits) = gates.limits.latest()? {
                receiver.home = Some(limits.home());
            }
            if let Some(motors) = gates.motors.try_recv()? {
                simulation.receive(&motors);
            }
            let readings = simulation.step();
            send(&mut gates, &readings).await?;
            receiver.step(&simulation)?;
            watch.step(&simulation).into_iter().for_each(|event| println!("{event}"));
        }
    }
}

async fn send(gates: &mut Simulator, readings: &Readings) -> scl::Result<()> {
    // Send the height before the inertial reading, which triggers the autopilot's next step.
    if let Some(height) = &readings.height {
        gates.height.send(height).await?;
    }
    gates.imu.send(&readings.inertial).await?;
    if let Some(world) = &readings.world {
        gates.world.send(world).await?;
    }
    if let Some(battery) = &readings.battery {
        gates.battery.send(battery).await?;
    }
    Ok(())
}

/// The GPS receiver at the serial port.
struct SerialReceiver {
    port: Option<SerialPort>,
    receiver: Receiver,
    /// `None` until `configuration` has told it.
    home: Option<Home>,
}

impl SerialReceiver {
    fn step(&mut self, simulation: &Simulation) -> scl::Result<()> {
        let (Some(port), Some(home)) = (&self.port, self.home) else { return Ok(()) };
        if simulation.steps().is_multiple_of(NMEA_PERIOD) {
            let world: arcade::World = truth(simulation.time_us(), &simulation.world);
            let fix = self.receiver.measure(&world, home);
            port.write(&nmea::sentences(&fix))?;
        }
        Ok(())
    }
}
