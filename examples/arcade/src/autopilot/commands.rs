//! Decides which commands are accepted, and explains why others are not.

use super::parameters::Parameters;
use super::vector::Vec3;
use crate::arcade::{Action, Command, Mode};

/// Below this height the vehicle only takes off and lands, m.
pub const LOWEST: f64 = 1.0;

/// The state of the vehicle that commands are checked against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Situation {
    pub mode: Mode,
    /// Height above home, m.
    pub height: f64,
    pub position_valid: bool,
}

/// Checks whether a command can be carried out now. The error says why not.
pub fn check(command: &Command, situation: &Situation, parameters: &Parameters) -> Result<(), String> {
    let target = Vec3::from(command.target);
    if !target.is_finite() || !command.yaw.is_finite() || !command.speed.is_finite() {
        return Err("a value is not a finite number".to_owned());
    }
    if command.id == 0 {
        return Err("the command has no id".to_owned());
    }
    let grounded = situation.mode == Mode::Grounded;
    match command.action() {
        Action::TakeOff if !grounded => Err("already in the air".to_owned()),
        Action::TakeOff if !situation.position_valid => Err("no position: waiting for a GPS fix".to_owned()),
        Action::TakeOff => check_height(target.z, parameters),
        Action::GoTo if grounded => Err("on the ground: take off first".to_owned()),
        Action::GoTo if situation.height < LOWEST => Err(format!("too low: below {LOWEST:.1} m")),
        Action::GoTo if !situation.position_valid => Err("no position: the last GPS fix is too old".to_owned()),
        Action::GoTo if command.speed < 0.0 => Err(format!("speed {:.1} m/s is negative", command.speed)),
        Action::GoTo => check_height(target.z, parameters).and_then(|()| check_distance(target, parameters)),
        Action::Land if grounded => Err("already on the ground".to_owned()),
        Action::Land => Ok(()),
        Action::Return => Err("the autopilot does not plan a return: send GO_TO and LAND".to_owned()),
        Action::Unknown => Err("unknown action".to_owned()),
    }
}

fn check_height(height: f64, parameters: &Parameters) -> Result<(), String> {
    if height < LOWEST {
        return Err(format!("height {height:.1} m is below {LOWEST:.1} m"));
    }
    if height > parameters.limits.fence_height {
        return Err(format!("height {height:.1} m is above the fence at {:.1} m", parameters.limits.fence_height));
    }
    Ok(())
}

fn check_distance(target: Vec3, parameters: &Parameters) -> Result<(), String> {
    let distance = target.horizontal();
    if distance > parameters.limits.fence_radius {
        return Err(format!(
            "target is {distance:.1} m from home, the fence at {:.1} m",
            parameters.limits.fence_radius
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arcade::Vector;

    const FLYING: Situation = Situation { mode: Mode::Flying, height: 5.0, position_valid: true };
    const GROUNDED: Situation = Situation { mode: Mode::Grounded, height: 0.0, position_valid: true };

    fn command(action: Action, x: f64, y: f64, z: f64) -> Command {
        Command { id: 1, action: action.into(), target: Some(Vector { x, y, z }), ..Command::default() }
    }

    #[test]
    fn commands_within_limits_are_accepted() {
        for (command, situation) in [
            (command(Action::TakeOff, 0.0, 0.0, 5.0), GROUNDED),
            (command(Action::GoTo, 60.0, -70.0, 29.0), FLYING),
            (command(Action::Land, 0.0, 0.0, 0.0), FLYING),
            (command(Action::Land, 0.0, 0.0, 0.0), Situation { position_valid: false, ..FLYING }),
        ] {
            assert_eq!(check(&command, &situation, &Parameters::defaults()), Ok(()));
        }
    }

    #[test]
    fn others_are_refused_with_the_reason() {
        let lost = |situation| Situation { position_valid: false, ..situation };
        for (command, situation, reason) in [
            (command(Action::TakeOff, 0.0, 0.0, 5.0), FLYING, "already in the air"),
            (command(Action::TakeOff, 0.0, 0.0, 5.0), lost(GROUNDED), "no position: waiting for a GPS fix"),
            (command(Action::TakeOff, 0.0, 0.0, 31.0), GROUNDED, "height 31.0 m is above the fence at 30.0 m"),
            (command(Action::TakeOff, 0.0, 0.0, 0.5), GROUNDED, "height 0.5 m is below 1.0 m"),
            (command(Action::GoTo, 0.0, 0.0, 5.0), GROUNDED, "on the ground: take off first"),
            (command(Action::GoTo, 0.0, 0.0, 5.0), Situation { height: 0.4, ..FLYING }, "too low: below 1.0 m"),
            (command(Action::GoTo, 0.0, 0.0, 5.0), lost(FLYING), "no position: the last GPS fix is too old"),
            (command(Action::GoTo, 90.0, 80.0, 5.0), FLYING, "target is 120.4 m from home, the fence at 100.0 m"),
            (command(Action::GoTo, f64::NAN, 0.0, 5.0), FLYING, "a value is not a finite number"),
            (Command { speed: -1.0, ..command(Action::GoTo, 0.0, 0.0, 5.0) }, FLYING, "speed -1.0 m/s is negative"),
            (command(Action::Land, 0.0, 0.0, 0.0), GROUNDED, "already on the ground"),
            (
                command(Action::Return, 0.0, 0.0, 0.0),
                FLYING,
                "the autopilot does not plan a return: send GO_TO and LAND",
            ),
            (Command { id: 1, action: 77, ..Command::default() }, FLYING, "unknown action"),
            (Command { id: 0, ..command(Action::Land, 0.0, 0.0, 0.0) }, FLYING, "the command has no id"),
        ] {
            assert_eq!(check(&command, &situation, &Parameters::defaults()), Err(reason.to_owned()), "{command:?}");
        }
    }
}
