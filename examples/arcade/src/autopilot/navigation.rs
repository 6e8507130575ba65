//! Navigation: the mode of flight, and the current set-point of the vehicle.
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
    /// Fly level, because the horizontal position is unknown.
    FlyLevel,
}

/// The part of the estimated state that navigation needs.
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
    /// Id of the command in effect.
    pub command_id: u32,
    pub target: Vec3,
    /// Radians.
    pub target_yaw: f64,
    /// Maximum speed, m/s.
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
        self.speed = parameters.limits.speed;
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

    /// Starts to land straight down from here; a moving vehicle lands where it can stop.
    fn land(&mut self) {
        self.enter(Mode::Landing);
        let velocity = self.set_point.velocity;
        // Braking takes the vehicle about as far as half a second at its current velocity.
        self.target = self.set_point.position + Vec3::new(velocity.x, velocity.y, 0.0) * 0.5;
        self.target.z = 0.0;
    }

    fn enter(&mut self, mode: Mode) {
        self.mode = mode;
        self.in_mode = 0.0;
        self.land_detector = LandDetector::default();
    }

    /// Advances the set-point by `elapsed` seconds, changes the mode when that is due, and returns what the motors are
    /// to do.
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
        // Let the target follow the estimate, so the vehicle holds its position once fixes return.
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
            Leg { target: self.target, yaw: self.target_yaw, speed: self.speed, climb: parameters.limits.climb };
        if self.mode == Mode::Landing {
            leg.target.z = UNDERGROUND;
            if self.set_point.position.z < FLARE {
                leg.climb = parameters.land_speed;
            }
        }
        leg
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arcade::Vector;

    const BEAT: f64 = 1.0 / 300.0;
    const GROUND: Estimate = Estimate {
        position: Vec3::new(1.0, 2.0, 0.0),
        velocity: Vec3::ZERO,
        yaw: 0.5,
        position_valid: true,
        thrust: 0.0,
    };

    fn command(action: Action, x: f64, y: f64, z: f64) -> Command {
        Command { id: 9, action: action.into(), target: Some(Vector { x, y, z }), ..Command::default() }
    }

    fn begun(action: Action, x: f64, y: f64, z: f64, estimate: &Estimate) -> Navigator {
        let mut navigator = Navigator::default();
        navigator.set_point.position = estimate.position;
        navigator.begin(&command(action, x, y, z), estimate, &Parameters::defaults());
        navigator
    }

    /// A vehicle that is exactly where it is to be.
    fn follow(navigator: &mut Navigator, seconds: f64, height: f64) -> Drive {
        let mut estimate = GROUND;
        (0..(seconds / BEAT) as usize).fold(Drive::Off, |_, _| {
            estimate.position = navigator.set_point.position;
            estimate.position.z = estimate.position.z.max(height);
            estimate.velocity = if estimate.position.z > height { navigator.set_point.velocity } else { Vec3::ZERO };
            navigator.update(&estimate, &Parameters::defaults(), BEAT)
        })
    }

    #[test]
    fn a_take_off_idles_then_climbs_straight_up() {
        let mut navigator = begun(Action::TakeOff, 50.0, 50.0, 5.0, &GROUND);
        assert_eq!(navigator.target, Vec3::new(1.0, 2.0, 5.0));
        assert_eq!(navigator.update(&GROUND, &Parameters::defaults(), 0.9), Drive::Idle);
        assert_eq!(navigator.set_point.position, GROUND.position);
        assert_eq!(follow(&mut navigator, 1.0, 0.0), Drive::Fly);
        assert_eq!(navigator.mode, Mode::TakingOff);
        follow(&mut navigator, 10.0, 0.0);
        assert_eq!(navigator.mode, Mode::Flying);
        assert!((navigator.set_point.position - navigator.target).length() < 0.05, "{navigator:?}");
        assert!((navigator.set_point.yaw - 0.5).abs() < 1e-9);
    }

    #[test]
    fn speeds_above_the_limit_are_reduced_to_it() {
        let up = Estimate { position: Vec3::new(0.0, 0.0, 5.0), ..GROUND };
        let mut navigator = begun(Action::TakeOff, 0.0, 0.0, 5.0, &up);
        for (asked, taken) in [(0.0, 4.0), (2.5, 2.5), (99.0, 4.0)] {
            let command = Command { speed: asked, ..command(Action::GoTo, 9.0, 0.0, 5.0) };
            navigator.begin(&command, &up, &Parameters::defaults());
            assert_eq!(navigator.speed, taken);
        }
    }

    #[test]
    fn a_landing_ends_on_the_ground() {
        let up = Estimate { position: Vec3::new(0.0, 0.0, 5.0), ..GROUND };
        let mut navigator = begun(Action::Land, 0.0, 0.0, 0.0, &up);
        follow(&mut navigator, 3.0, 0.0);
        assert_eq!(navigator.mode, Mode::Landing);
        follow(&mut navigator, 12.0, 0.0);
        assert_eq!(navigator.mode, Mode::Grounded);
        assert_eq!(follow(&mut navigator, 0.1, 0.0), Drive::Off);
    }

    #[test]
    fn without_position_it_lands_level_and_stays_where_the_position_returns() {
        let lost = Estimate { position: Vec3::new(0.0, 0.0, 5.0), position_valid: false, ..GROUND };
        let mut navigator = begun(Action::GoTo, 30.0, 0.0, 5.0, &lost);
        assert_eq!(navigator.update(&lost, &Parameters::defaults(), BEAT), Drive::FlyLevel);
        assert_eq!(navigator.mode, Mode::Landing);
        let found = Estimate { position: Vec3::new(8.0, 9.0, 4.0), position_valid: true, ..lost };
        navigator.update(&Estimate { position_valid: false, ..found }, &Parameters::defaults(), BEAT);
        assert_eq!(navigator.update(&found, &Parameters::defaults(), BEAT), Drive::Fly);
        assert_eq!((navigator.target.x, navigator.target.y), (8.0, 9.0));
    }
}
