//! Navigation: the mode of flight, and where the vehicle is to be now.
//!
//! Grounded -> taking off -> flying -> landing -> grounded. Commands and the land detector change the mode.

use super::landing::LandDetector;
use super::parameters::Parameters;
use super::trajectory::{Leg, SetPoint};
use super::vector::Vec3;
use crate::arcade::{Action, Command, Mode};

/// The motors idle for this long before take-off, s.
const SPIN_UP: f64 = 1.0;
/// A take-off is complete this close to its height, m.
const REACHED: f64 = 0.3;
/// Below this height the vehicle sinks slowly, m.
const FLARE: f64 = 3.0;
/// The set-point of a landing goes on below the ground, so that the thrust decreases after touching down, m.
const UNDERGROUND: f64 = -5.0;

/// What the motors are to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    Off,
    Idle,
    Fly,
    /// Without horizontal position.
    FlyLevel,
}

/// Where the vehicle is, as far as navigation wants to know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    pub position: Vec3,
    pub velocity: Vec3,
    /// Radians.
    pub yaw: f64,
    pub position_valid: bool,
    /// Mean set-point of the motors.
    pub thrust: f64,
}

/// The state of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Navigator {
    pub mode: Mode,
    /// Of the command in effect.
    pub command_id: u32,
    pub target: Vec3,
    /// Radians.
    pub target_yaw: f64,
    /// m/s, at most.
    pub speed: f64,
    pub set_point: SetPoint,
    /// Seconds since the mode began.
    pub in_mode: f64,
    pub land_detector: LandDetector,
}

impl Default for Navigator {
    fn default() -> Self {
        Self {
            mode: Mode::Grounded,
            command_id: 0,
            target: Vec3::ZERO,
            target_yaw: 0.0,
            speed: 0.0,
            set_point: SetPoint::default(),
            in_mode: 0.0,
            land_detector: LandDetector::default(),
        }
    }
}

impl Navigator {
    /// Starts to carry out a command that was checked.
    pub fn begin(&mut self, command: &Command, estimate: &Estimate, parameters: &Parameters) {
        self.command_id = command.id;
        self.speed = parameters.limit_speed;
        let target = Vec3::from(command.target);
        match command.action() {
            Action::TakeOff => {
                self.enter(Mode::TakingOff);
                self.set_point = SetPoint::at(estimate.position, estimate.yaw);
                self.target = Vec3::new(estimate.position.x, estimate.position.y, target.z);
                self.target_yaw = estimate.yaw;
            }
            Action::GoTo => {
                self.enter(Mode::Flying);
                self.target = target;
                self.target_yaw = command.yaw;
                if command.speed > 0.0 && command.speed < self.speed {
                    self.speed = command.speed;
                }
            }
            Action::Land => self.land(),
            Action::Return | Action::Unknown => {}
        }
    }

    /// Straight down from here; a movement ends where it can stop.
    fn land(&mut self) {
        self.enter(Mode::Landing);
        let velocity = self.set_point.velocity;
        // Half a second at the present velocity is where braking takes it, nearly.
        self.target = self.set_point.position + Vec3::new(velocity.x, velocity.y, 0.0) * 0.5;
        self.target.z = 0.0;
    }

    fn enter(&mut self, mode: Mode) {
        self.mode = mode;
        self.in_mode = 0.0;
        self.land_detector = LandDetector::default();
    }

    /// Moves the set-point on by `elapsed` seconds and changes the mode when its time has come.
    pub fn update(&mut self, estimate: &Estimate, parameters: &Parameters, elapsed: f64) -> Drive {
        self.in_mode += elapsed;
        let airborne = self.mode == Mode::Flying || self.mode == Mode::TakingOff && self.in_mode > SPIN_UP;
        if airborne && !estimate.position_valid {
            self.land();
        }
        let landed = self.mode == Mode::Landing && self.has_landed(estimate, parameters, elapsed);
        match self.mode {
            Mode::Grounded => return Drive::Off,
            Mode::TakingOff if self.in_mode <= SPIN_UP => {
                self.set_point = SetPoint::at(estimate.position, estimate.yaw);
                return Drive::Idle;
            }
            Mode::TakingOff if (self.target.z - estimate.position.z).abs() < REACHED => self.enter(Mode::Flying),
            Mode::Landing if landed => {
                self.enter(Mode::Grounded);
                return Drive::Off;
            }
            _ => {}
        }
        self.set_point.advance(&self.leg(parameters), parameters, elapsed);
        if estimate.position_valid {
            return Drive::Fly;
        }
        // Once fixes come again, the vehicle is to stay where it then is.
        self.target = Vec3::new(estimate.position.x, estimate.position.y, self.target.z);
        self.set_point.position = Vec3::new(estimate.position.x, estimate.position.y, self.set_point.position.z);
        self.set_point.velocity = Vec3::new(0.0, 0.0, self.set_point.velocity.z);
        Drive::FlyLevel
    }

    fn has_landed(&mut self, estimate: &Estimate, parameters: &Parameters, elapsed: f64) -> bool {
        let (height, climb) = (estimate.position.z, estimate.velocity.z);
        self.land_detector.update(height, climb, estimate.thrust, parameters, elapsed)
    }

    fn leg(&self, parameters: &Parameters) -> Leg {
        let mut leg =
            Leg { target: self.target, yaw: self.target_yaw, speed: self.speed, climb: parameters.limit_climb };
        if self.mode == Mode::Landing {
            leg.target.z = UNDERGROUND;
            if self.set_point.position.z < FLARE {
                leg.climb = parameters.land_speed;
            }
        }
        leg
    }
}
