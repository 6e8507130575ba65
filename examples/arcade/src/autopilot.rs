//! The autopilot: from readings to set-points of the motors, once per inertial reading.
//!
//! Its outputs depend only on the messages and the times in them, not on clocks or the order of arrival, so a recorded
//! flight can be repeated exactly, also by the twin in C, which has the same files.

pub mod attitude;
pub mod commands;
pub mod control;
pub mod landing;
pub mod mixer;
pub mod navigation;
pub mod parameters;
pub mod pending;
pub mod position;
pub mod quaternion;
pub mod resume;
pub mod state;
pub mod trajectory;
pub mod vector;

use crate::AutopilotParameters;
use crate::arcade::{Command, CommandResult, Fix, Flight, Height, Inertial, Limits, Mode, Motors};
use attitude::AttitudeEstimator;
use commands::Situation;
use control::{RateController, VelocityController};
use navigation::{Drive, Estimate, Navigator};
use parameters::Parameters;
use pending::Pending;
use position::PositionEstimator;
use vector::Vec3;

/// Measurements take effect this long after the time at which they were taken, so that they have arrived by then.
const HEIGHT_DELAY_US: u64 = 20_000;
const FIX_DELAY_US: u64 = 60_000;
/// `Flight` messages per second.
const FLIGHT_RATE: u64 = 30;
/// A longer time between two readings, s, is a gap: readings were lost, or the autopilot was started again.
const GAP: f64 = 0.02;
/// After a longer gap than this, the state is of no use.
const LONGEST_GAP_US: u64 = 2_000_000;

/// The outputs of one beat.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outputs {
    pub motors: Motors,
    /// Present at some of the beats only.
    pub flight: Option<Flight>,
}

/// The whole state of the autopilot.
#[derive(Clone, Debug)]
pub struct FlightController {
    /// Time of the last reading; 0 before the first.
    pub time_us: u64,
    pub parameters: Parameters,
    pub attitude: AttitudeEstimator,
    pub position: PositionEstimator,
    pub navigator: Navigator,
    pub velocity_controller: VelocityController,
    pub rate_controller: RateController,
    /// The mean set-point of the motors at the last beat.
    pub thrust: f64,
    /// By how much the motors missed roll, pitch and yaw at the last beat.
    pub cut: Vec3,
    /// Number of restarts of the autopilot in the air.
    pub restarts: u32,
    heights: Pending<Height>,
    fixes: Pending<Fix>,
    commands: Pending<Command>,
    new_parameters: Option<Parameters>,
}

impl FlightController {
    /// Stands on the ground.
    pub fn new(parameters: Parameters) -> Self {
        Self {
            time_us: 0,
            parameters,
            attitude: AttitudeEstimator::default(),
            position: PositionEstimator::default(),
            navigator: Navigator::default(),
            velocity_controller: VelocityController::default(),
            rate_controller: RateController::default(),
            thrust: 0.0,
            cut: Vec3::ZERO,
            restarts: 0,
            heights: Pending::default(),
            fixes: Pending::default(),
            commands: Pending::default(),
            new_parameters: None,
        }
    }

    /// Takes a height, which takes effect a fixed time after it was measured.
    pub fn receive_height(&mut self, height: &Height) {
        self.heights.insert(height.time_us + HEIGHT_DELAY_US, *height);
    }

    /// Takes a fix, which takes effect a fixed time after it was measured.
    pub fn receive_fix(&mut self, fix: &Fix) {
        self.fixes.insert(fix.time_us + FIX_DELAY_US, *fix);
    }

    /// Takes limits, which take effect at the next whole second.
    pub fn receive_limits(&mut self, limits: &Limits) {
        self.new_parameters = Some(Parameters { limits: *limits, ..self.newest_parameters() });
    }

    /// Takes its own parameters. If they have changed, they take effect at the next whole second.
    pub fn receive_parameters(&mut self, own: &AutopilotParameters) {
        let newest = self.newest_parameters();
        let parameters = Parameters::new(own, newest.limits);
        if parameters != newest {
            self.new_parameters = Some(parameters);
        }
    }

    fn newest_parameters(&self) -> Parameters {
        self.new_parameters.unwrap_or(self.parameters)
    }

    /// Takes a command, which takes effect at the time that it states, and returns whether it is accepted. A command
    /// that is repeated because its result was lost is accepted again, without effect.
    pub fn receive_command(&mut self, command: &Command) -> CommandResult {
        let known =
            command.id == self.navigator.command_id || self.commands.iter().any(|pending| pending.id == command.id);
        if !known || command.id == 0 {
            if let Err(reason) = commands::check(command, &self.situation(), &self.parameters) {
                return CommandResult { accepted: false, reason };
            }
            self.commands.insert(command.effective_us, *command);
        }
        CommandResult { accepted: true, reason: String::new() }
    }

    /// Processes one beat. Returns `None` for a reading that is not newer than the last.
    pub fn step(&mut self, reading: &Inertial) -> Option<Outputs> {
        let now = reading.time_us;
        if now + LONGEST_GAP_US < self.time_us {
            // The vehicle's clock has restarted.
            *self = Self::new(self.newest_parameters());
        }
        if now <= self.time_us {
            return None;
        }
        let before = std::mem::replace(&mut self.time_us, now);
        // Not at once: when they arrive depends on the machine, and a recorded flight is to be repeated exactly.
        let whole_second = before / 1_000_000 != now / 1_000_000;
        if whole_second && let Some(parameters) = self.new_parameters.take() {
            self.parameters = parameters;
        }
        let elapsed = self.estimate(reading, before);
        let estimate = self.estimated();
        self.begin_commands(&estimate);
        let drive = self.navigator.update(&estimate, &self.parameters, elapsed);
        let motors = self.control(drive, elapsed);
        let flight = before * FLIGHT_RATE / 1_000_000 != now * FLIGHT_RATE / 1_000_000;
        Some(Outputs { motors: set_points(now, motors), flight: flight.then(|| self.flight()) })
    }

    /// Brings the estimates to the time of the reading. Returns the step for the controllers, s.
    fn estimate(&mut self, reading: &Inertial, before: u64) -> f64 {
        let (rates, angles) = (Vec3::from(reading.rates), Vec3::from(reading.angles));
        let elapsed = if before == 0 { 0.0 } else { (reading.time_us - before) as f64 * 1e-6 };
        if before == 0 || elapsed > GAP {
            self.attitude.reset(rates, angles);
            self.position.coast(reading.time_us, self.attitude.attitude, elapsed);
            self.rate_controller.rates = self.attitude.rates;
        } else {
            self.attitude.update(rates, angles, elapsed, &self.parameters);
            let force = Vec3::from(reading.acceleration);
            self.position.predict(reading.time_us, force, self.attitude.attitude, elapsed);
        }
        while let Some(height) = self.heights.take_due(reading.time_us) {
            self.position.correct_height(&height, &self.parameters);
        }
        while let Some(fix) = self.fixes.take_due(reading.time_us) {
            self.position.correct_fix(&fix, &self.parameters);
        }
        if elapsed > GAP || before == 0 { GAP } else { elapsed }
    }

    /// Begins the commands that are due. Each is checked again, because the situation may have changed since it was
    /// accepted.
    fn begin_commands(&mut self, estimate: &Estimate) {
        while let Some(command) = self.commands.take_due(self.time_us) {
            if commands::check(&command, &self.situation(), &self.parameters).is_ok() {
                self.navigator.begin(&command, estimate, &self.parameters);
            }
        }
    }

    fn control(&mut self, drive: Drive, elapsed: f64) -> [f64; 4] {
        let motors = match drive {
            Drive::Off | Drive::Idle => {
                self.velocity_controller = VelocityController::default();
                self.rate_controller = RateController { rates: self.attitude.rates, ..RateController::default() };
                self.cut = Vec3::ZERO;
                [if drive == Drive::Off { 0.0 } else { self.parameters.thrust_minimum }; 4]
            }
            Drive::Fly | Drive::FlyLevel => {
                let thrust = self.velocity_controller.update(
                    &self.navigator.set_point,
                    self.position.position,
                    self.position.velocity,
                    drive == Drive::FlyLevel,
                    &self.parameters,
                    elapsed,
                );
                let demand = self.rate_controller.update(
                    &thrust,
                    self.attitude.attitude,
                    self.attitude.rates,
                    self.cut,
                    &self.parameters,
                    elapsed,
                );
                let mixed = mixer::mix(&demand);
                self.cut = mixed.cut;
                mixed.motors
            }
        };
        self.thrust = 0.25 * (motors[0] + motors[1] + motors[2] + motors[3]);
        motors
    }

    fn estimated(&self) -> Estimate {
        Estimate {
            position: self.position.position,
            velocity: self.position.velocity,
            yaw: self.attitude.attitude.angles().z,
            position_valid: self.position.is_valid(self.time_us),
            thrust: self.thrust,
        }
    }

    fn situation(&self) -> Situation {
        Situation {
            mode: self.navigator.mode,
            height: self.position.position.z,
            position_valid: self.position.is_valid(self.time_us),
        }
    }

    fn flight(&self) -> Flight {
        Flight {
            time_us: self.time_us,
            mode: self.navigator.mode.into(),
            command_id: self.navigator.command_id,
            position: Some(self.position.position.into()),
            velocity: Some(self.position.velocity.into()),
            attitude: Some(self.attitude.attitude.angles().into()),
            target: Some(self.navigator.target.into()),
            target_yaw: self.navigator.target_yaw,
            position_valid: self.position.is_valid(self.time_us),
            restarts: self.restarts,
        }
    }

    /// Carries on in the air from a saved state, if it is recent at the time of the first reading.
    pub fn resumed(mut self, reading_us: u64) -> Option<Self> {
        let recent = reading_us > self.time_us && reading_us - self.time_us <= LONGEST_GAP_US;
        if self.navigator.mode == Mode::Grounded || !recent {
            return None;
        }
        self.restarts += 1;
        Some(self)
    }
}

fn set_points(time_us: u64, motors: [f64; 4]) -> Motors {
    let [front_left, front_right, rear_left, rear_right] = motors;
    Motors { time_us, front_left, front_right, rear_left, rear_right }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Autopilot;
    use crate::arcade::{Action, Vector};

    const BEAT_US: u64 = 3_333;

    fn reading(beat: u64) -> Inertial {
        let vector = |z| Some(Vector { z, ..Vector::default() });
        Inertial { time_us: beat * BEAT_US, acceleration: vector(9.81), rates: vector(0.0), angles: vector(0.0) }
    }

    /// Standing on the ground with a position, after one second.
    fn ready() -> FlightController {
        let mut controller = FlightController::new(Parameters::defaults());
        let home = controller.parameters.limits.home();
        let (latitude, longitude) = (home.latitude, home.longitude);
        controller.receive_fix(&Fix { time_us: BEAT_US, quality: 2, latitude, longitude, ..Fix::default() });
        (1..300).for_each(|beat| assert!(controller.step(&reading(beat)).is_some()));
        controller
    }

    fn take_off(id: u32, effective_us: u64) -> Command {
        let target = Some(Vector { z: 5.0, ..Vector::default() });
        Command { id, action: Action::TakeOff.into(), target, effective_us, ..Command::default() }
    }

    #[test]
    fn flight_is_reported_30_times_a_second_and_motors_at_each_beat() {
        let mut controller = FlightController::new(Parameters::defaults());
        let outputs: Vec<_> = (1..=300).filter_map(|beat| controller.step(&reading(beat))).collect();
        assert_eq!(outputs.len(), 300);
        assert_eq!(outputs.iter().filter(|outputs| outputs.flight.is_some()).count(), 29);
        assert!(outputs.iter().all(|outputs| outputs.motors.front_left == 0.0));
        assert_eq!(outputs[299].motors.time_us, 300 * BEAT_US);
    }

    #[test]
    fn a_reading_that_is_not_newer_is_ignored_until_the_clock_starts_again() {
        let mut controller = ready();
        assert_eq!(controller.step(&reading(299)), None);
        assert_eq!(controller.step(&reading(10)), None);
        (300..1000).for_each(|beat| assert!(controller.step(&reading(beat)).is_some()));
        assert!(controller.step(&reading(1)).is_some());
        assert!(!controller.position.is_valid(controller.time_us));
    }

    #[test]
    fn a_command_takes_effect_at_its_time() {
        let mut controller = ready();
        assert!(controller.receive_command(&take_off(7, 310 * BEAT_US)).accepted);
        let mode = |beat, controller: &mut FlightController| {
            controller.step(&reading(beat));
            controller.navigator.mode
        };
        (300..310).for_each(|beat| assert_eq!(mode(beat, &mut controller), Mode::Grounded));
        assert_eq!(mode(310, &mut controller), Mode::TakingOff);
        assert_eq!(controller.navigator.command_id, 7);
    }

    #[test]
    fn a_command_that_is_repeated_has_no_second_effect() {
        let mut controller = ready();
        assert!(controller.receive_command(&take_off(7, 0)).accepted);
        assert!(controller.receive_command(&take_off(7, 0)).accepted);
        controller.step(&reading(300));
        controller.step(&reading(301));
        assert!(controller.receive_command(&take_off(7, 0)).accepted);
        assert_eq!(controller.receive_command(&take_off(8, 0)).reason, "already in the air");
        assert_eq!(controller.receive_command(&take_off(0, 0)).reason, "the command has no id");
    }

    #[test]
    fn parameters_take_effect_at_the_next_whole_second() {
        let mut controller = ready();
        let (autopilot, _peer) = Autopilot::test_blocking().expect("opened");
        controller.receive_parameters(&autopilot.parameters);
        assert_eq!(controller.new_parameters, None, "nothing has changed");
        autopilot.parameters.attitude_p.set("5").expect("a value that it can have");
        controller.receive_parameters(&autopilot.parameters);
        controller.receive_limits(&Limits { speed: 2.0, ..controller.parameters.limits });
        let values =
            |controller: &FlightController| (controller.parameters.attitude_p, controller.parameters.limits.speed);
        controller.step(&reading(300));
        assert_eq!(values(&controller), (6.0, 4.0));
        controller.step(&reading(301));
        assert_eq!(values(&controller), (5.0, 2.0));
    }
}
