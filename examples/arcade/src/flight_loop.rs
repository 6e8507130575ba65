//! The program `autopilot`: one beat for each inertial reading.

use crate::Autopilot;
use crate::arcade::{Beat, CommandResult, Inertial, Limits, Mode};
use crate::autopilot::parameters::Parameters;
use crate::autopilot::resume::StateFile;
use crate::autopilot::{FlightController, Outputs, state};
use rustix::time::{ClockId, clock_gettime};
use scl::RecvTimeoutError;
use std::path::Path;
use std::time::Duration;

/// After this time without readings, the autopilot reports their absence and refuses commands.
const SILENCE: Duration = Duration::from_millis(200);

/// The state file, and what was read from it.
#[derive(Debug, Default)]
pub struct Memory {
    file: Option<StateFile>,
    saved: Option<Vec<f64>>,
}

impl Memory {
    /// Opens the state file. Without it, the autopilot flies but cannot carry on after a crash.
    pub fn open(path: &Path) -> Self {
        match StateFile::open(path, state::COUNT) {
            Ok((file, saved)) => Self { file: Some(file), saved },
            Err(error) => {
                eprintln!("warning: no state for a restart in the air: {}: {error}", path.display());
                Self::default()
            }
        }
    }

    fn store(&mut self, controller: &FlightController) {
        if let Some(file) = &mut self.file
            && let Err(error) = file.store(&state::save(controller))
        {
            eprintln!("warning: no state for a restart in the air: {error}");
            self.file = None;
        }
    }
}

/// Flies until the program is stopped.
///
/// # Errors
/// Errors of the gates.
pub fn run(mut gates: Autopilot, mut memory: Memory) -> scl::Result<()> {
    let mut controller = None;
    let mut mode = Mode::Grounded;
    let mut silent = false;
    loop {
        let reading = match gates.imu.recv_timeout(SILENCE) {
            Ok(reading) => reading,
            Err(RecvTimeoutError::Timeout { .. }) => {
                if !silent {
                    println!("no inertial readings for {} ms", SILENCE.as_millis());
                }
                silent = true;
                refuse_commands(&mut gates)?;
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        silent = false;
        let began_ns = monotonic_ns();
        let controller = controller.get_or_insert_with(|| begin(&gates, memory.saved.take(), &reading));
        let Some(outputs) = beat(&mut gates, controller, &reading)? else { continue };
        let took_ns = u32::try_from(monotonic_ns() - began_ns).unwrap_or(u32::MAX);
        memory.store(controller);
        finish(&mut gates, controller, &outputs, Beat { time_us: reading.time_us, began_ns, took_ns })?;
        report(&mut mode, controller);
    }
}

/// Carries on in the air from the saved state, or starts on the ground.
fn begin(gates: &Autopilot, saved: Option<Vec<f64>>, reading: &Inertial) -> FlightController {
    let parameters = Parameters::new(&gates.parameters, Limits::default());
    let saved = saved.and_then(|numbers| state::restore(&numbers, parameters));
    if let Some(resumed) = saved.and_then(|saved| saved.resumed(reading.time_us)) {
        println!("carrying on in the air: restart {}", resumed.restarts);
        return resumed;
    }
    println!("ready on the ground");
    FlightController::new(parameters)
}

/// The urgent part of a beat: from the readings to the motors.
fn beat(gates: &mut Autopilot, controller: &mut FlightController, reading: &Inertial) -> scl::Result<Option<Outputs>> {
    if let Some(limits) = gates.limits.latest()? {
        controller.receive_limits(&limits);
    }
    controller.receive_parameters(&gates.parameters);
    while let Some(height) = gates.height.try_recv()? {
        controller.receive_height(&height);
    }
    while let Some(fix) = gates.fix.try_recv()? {
        controller.receive_fix(&fix);
    }
    let outputs = controller.step(reading);
    if let Some(outputs) = &outputs {
        gates.motors.send_blocking(&outputs.motors)?;
    }
    Ok(outputs)
}

/// The part of a beat that may wait until the motors have their set-points.
fn finish(gates: &mut Autopilot, controller: &mut FlightController, outputs: &Outputs, beat: Beat) -> scl::Result<()> {
    gates.beats.send_blocking(&beat)?;
    if let Some(flight) = &outputs.flight {
        gates.flight.send_blocking(flight)?;
    }
    while let Some(request) = gates.control.try_recv()? {
        let result = controller.receive_command(&request);
        if !result.accepted {
            println!("command {} refused: {}", request.id, result.reason);
        }
        // A caller that has been stopped no longer waits for the result.
        let _gone = request.reply(&result);
    }
    Ok(())
}

fn refuse_commands(gates: &mut Autopilot) -> scl::Result<()> {
    while let Some(request) = gates.control.try_recv()? {
        let _gone = request.reply(&CommandResult { accepted: false, reason: "no inertial readings".to_owned() });
    }
    Ok(())
}

/// Prints one line when the mode has changed.
fn report(last: &mut Mode, controller: &FlightController) {
    let navigator = &controller.navigator;
    if navigator.mode == *last {
        return;
    }
    *last = navigator.mode;
    let position = controller.position.position;
    match navigator.mode {
        Mode::Grounded => println!("landed, {:.2} m from home", position.horizontal()),
        Mode::TakingOff => println!("taking off to {:.1} m", navigator.target.z),
        Mode::Flying => println!("flying at {:.1} m", position.z),
        Mode::Landing => println!("landing from {:.1} m", position.z),
    }
}

fn monotonic_ns() -> u64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec as u64 * 1_000_000_000 + now.tv_nsec as u64
}
