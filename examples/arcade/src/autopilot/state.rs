//! The part of the autopilot's state that is kept for a restart in the air, as a list of numbers.

use super::FlightController;
use super::parameters::Parameters;
use super::vector::Vec3;
use crate::arcade::Mode;

/// How many numbers a state has.
pub const COUNT: usize = 63;

/// The numbers of a state, in a fixed order.
pub fn save(state: &FlightController) -> Vec<f64> {
    let mut copy = state.clone();
    let mut numbers = Vec::with_capacity(COUNT);
    visit(&mut copy, &mut |number| numbers.push(*number));
    debug_assert_eq!(numbers.len(), COUNT);
    numbers
}

/// Restores a state from its numbers; its limits, too, but no other parameters. Returns `None` unless there are
/// [`COUNT`] of them.
pub fn restore(numbers: &[f64], parameters: Parameters) -> Option<FlightController> {
    if numbers.len() != COUNT {
        return None;
    }
    let mut state = FlightController::new(parameters);
    let mut numbers = numbers.iter();
    visit(&mut state, &mut |number| *number = numbers.next().copied().unwrap_or_default());
    Some(state)
}

/// Calls `number` with each number of the state, to read or replace it. Whole numbers are exact up to 2^53.
fn visit(state: &mut FlightController, number: &mut impl FnMut(&mut f64)) {
    whole(&mut state.time_us, number);
    number(&mut state.thrust);
    let mut restarts = u64::from(state.restarts);
    whole(&mut restarts, number);
    state.restarts = restarts as u32;

    let attitude = &mut state.attitude;
    for component in
        [&mut attitude.attitude.w, &mut attitude.attitude.x, &mut attitude.attitude.y, &mut attitude.attitude.z]
    {
        number(component);
    }
    vectors([&mut attitude.bias, &mut attitude.rates], number);

    let position = &mut state.position;
    vectors([&mut position.position, &mut position.velocity, &mut position.bias], number);
    number(&mut position.barometer_offset);
    whole(&mut position.fix_us, number);
    whole(&mut position.height_us, number);

    let navigator = &mut state.navigator;
    let mut mode = navigator.mode as i32 as u64;
    whole(&mut mode, number);
    navigator.mode = Mode::try_from(mode as i32).unwrap_or(Mode::Grounded);
    let mut command_id = u64::from(navigator.command_id);
    whole(&mut command_id, number);
    navigator.command_id = command_id as u32;
    let point = &mut navigator.set_point;
    vectors([&mut navigator.target, &mut point.position, &mut point.velocity, &mut point.acceleration], number);
    for value in [&mut navigator.target_yaw, &mut navigator.speed, &mut point.yaw, &mut navigator.in_mode] {
        number(value);
    }
    number(&mut navigator.land_detector.still);

    let rates = &mut state.rate_controller;
    let integral = &mut state.velocity_controller.integral;
    vectors([integral, &mut rates.integral, &mut rates.rates, &mut rates.derivative], number);

    let limits = &mut state.parameters.limits;
    for value in [
        &mut limits.home_latitude,
        &mut limits.home_longitude,
        &mut limits.home_altitude,
        &mut limits.fence_radius,
        &mut limits.fence_height,
        &mut limits.speed,
        &mut limits.climb,
    ] {
        number(value);
    }
}

fn vectors<const N: usize>(vectors: [&mut Vec3; N], number: &mut impl FnMut(&mut f64)) {
    for vector in vectors {
        number(&mut vector.x);
        number(&mut vector.y);
        number(&mut vector.z);
    }
}

fn whole(value: &mut u64, number: &mut impl FnMut(&mut f64)) {
    let mut float = *value as f64;
    number(&mut float);
    *value = float as u64;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_is_saved_and_restored() {
        let numbers: Vec<f64> = (0..COUNT).map(|index| index as f64).collect();
        let restored = restore(&numbers, Parameters::defaults()).expect("a state");
        let mut expected = numbers.clone();
        // The mode is the only number that cannot have every value.
        let mode = expected.iter().position(|number| *number == MODE as f64).expect("an index");
        expected[mode] = 0.0;
        assert_eq!(save(&restored), expected);
        assert_eq!(restored.time_us, 0);
        assert_eq!(restored.navigator.mode, Mode::Grounded);
    }

    #[test]
    fn a_list_of_another_length_is_not_a_state() {
        for count in [0, COUNT - 1, COUNT + 1] {
            assert!(restore(&vec![0.0; count], Parameters::defaults()).is_none(), "{count}");
        }
    }

    /// The index of the mode.
    const MODE: usize = 25;
}
