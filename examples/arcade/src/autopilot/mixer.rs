//! Mixing: from collective thrust and torques to the set-points of four motors.
//!
//! When the motors cannot give everything, roll and pitch come first, because they keep the vehicle upright; then
//! thrust, then yaw (as "airmode" in PX4's control allocation).

use super::vector::Vec3;

/// What the controllers ask for. Roll, pitch and yaw are differences of motor set-points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Mean set-point of the motors, 0 to 1.
    pub thrust: f64,
    pub roll: f64,
    pub pitch: f64,
    pub yaw: f64,
}

/// Set-points of the motors in the order of the message: front left, front right, rear left, rear right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mixed {
    pub motors: [f64; 4],
    /// Roll, pitch and yaw as achieved minus as demanded; 0 unless an axis was reduced.
    pub cut: Vec3,
}

/// Left motors cause positive roll; rear motors lower the nose, which is positive pitch.
const ROLL: [f64; 4] = [1.0, -1.0, 1.0, -1.0];
const PITCH: [f64; 4] = [-1.0, -1.0, 1.0, 1.0];
/// Front left and rear right turn clockwise, so that their torque turns the vehicle counter-clockwise.
const YAW: [f64; 4] = [1.0, -1.0, -1.0, 1.0];

/// Mixes a demand for motors of the X configuration.
pub fn mix(demand: &Demand) -> Mixed {
    let mut tilt = [0.0; 4];
    let (mut least, mut most) = (0.0, 0.0);
    for motor in 0..4 {
        tilt[motor] = ROLL[motor] * demand.roll + PITCH[motor] * demand.pitch;
        least = if tilt[motor] < least { tilt[motor] } else { least };
        most = if tilt[motor] > most { tilt[motor] } else { most };
    }
    let span: f64 = most - least;
    let kept = if span > 1.0 { 1.0 / span } else { 1.0 };
    // Shift the thrust so that roll and pitch saturate no motor.
    let mut thrust = demand.thrust;
    thrust = if thrust > 1.0 - most * kept { 1.0 - most * kept } else { thrust };
    thrust = if thrust < -least * kept { -least * kept } else { thrust };
    let yaw = limit_yaw(demand.yaw, &tilt, kept, thrust);
    let mut motors = [0.0; 4];
    for motor in 0..4 {
        motors[motor] = (thrust + tilt[motor] * kept + YAW[motor] * yaw).clamp(0.0, 1.0);
    }
    let cut = Vec3::new(demand.roll * kept - demand.roll, demand.pitch * kept - demand.pitch, yaw - demand.yaw);
    Mixed { motors, cut }
}

/// As much of the yaw as keeps each motor between 0 and 1.
fn limit_yaw(yaw: f64, tilt: &[f64; 4], kept: f64, thrust: f64) -> f64 {
    let size = yaw.abs();
    let mut allowed = size;
    for motor in 0..4 {
        let before = thrust + tilt[motor] * kept;
        let room = if YAW[motor] * yaw > 0.0 { 1.0 - before } else { before };
        allowed = if room < allowed { room } else { allowed };
    }
    allowed = if allowed < 0.0 { 0.0 } else { allowed };
    if allowed == size {
        yaw
    } else if yaw < 0.0 {
        -allowed
    } else {
        allowed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sums(motors: [f64; 4]) -> Demand {
        let sum = |signs: [f64; 4]| (0..4).map(|motor| signs[motor] * motors[motor]).sum::<f64>() / 4.0;
        Demand { thrust: sum([1.0; 4]), roll: sum(ROLL), pitch: sum(PITCH), yaw: sum(YAW) }
    }

    #[test]
    fn a_demand_within_limits_is_met_exactly() {
        let demand = Demand { thrust: 0.5, roll: 0.1, pitch: -0.2, yaw: 0.05 };
        let mixed = mix(&demand);
        let met = sums(mixed.motors);
        assert_eq!(mixed.cut, Vec3::ZERO);
        assert!((met.thrust - demand.thrust).abs() < 1e-12 && (met.roll - demand.roll).abs() < 1e-12);
        assert!((met.pitch - demand.pitch).abs() < 1e-12 && (met.yaw - demand.yaw).abs() < 1e-12);
    }

    #[test]
    fn roll_and_pitch_survive_full_thrust_and_full_yaw() {
        let demand = Demand { thrust: 1.0, roll: 0.2, pitch: 0.1, yaw: 0.5 };
        let mixed = mix(&demand);
        let met = sums(mixed.motors);
        assert!(mixed.cut.x == 0.0 && mixed.cut.y == 0.0 && (mixed.cut.z - (met.yaw - 0.5)).abs() < 1e-12, "{mixed:?}");
        assert!((met.roll - 0.2).abs() < 1e-12 && (met.pitch - 0.1).abs() < 1e-12, "{met:?}");
        assert!(mixed.motors.iter().all(|motor| (0.0..=1.0).contains(motor)));
    }

    #[test]
    fn without_thrust_the_motors_speed_up_to_stay_upright() {
        let met = sums(mix(&Demand { thrust: 0.0, roll: 0.1, pitch: 0.0, yaw: 0.0 }).motors);
        assert!((met.roll - 0.1).abs() < 1e-12 && (met.thrust - 0.1).abs() < 1e-12, "{met:?}");
    }

    #[test]
    fn impossible_torques_keep_their_direction() {
        let mixed = mix(&Demand { thrust: 0.5, roll: 2.0, pitch: 1.0, yaw: 0.0 });
        let met = sums(mixed.motors);
        assert!((met.roll / met.pitch - 2.0).abs() < 1e-12, "{met:?}");
        assert!((mixed.cut - Vec3::new(met.roll - 2.0, met.pitch - 1.0, 0.0)).length() < 1e-12, "{mixed:?}");
    }
}
