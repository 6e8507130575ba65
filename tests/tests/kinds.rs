//! One program runs every component of a kind.

use crate::programs::{MOTORS, open_with};
use scl_tests::{Process, System, on_each_transport};

fn motor(system: &System, component: &str) -> Process {
    let mut motor = system.start_with(MOTORS, &[], &[("SCL_COMPONENT", component)]);
    motor.expect(component.trim_start_matches("motors."));
    motor
}

#[test]
fn each_process_is_the_component_that_it_was_started_as() {
    on_each_transport(|system| {
        let mut controller = open_with(&system, MOTORS, "controller");
        let _left = motor(&system, "left_motor");
        let right = motor(&system, "motors.right.motor");
        for (command, answer) in
            [("left 1", "left_motor 10"), ("right 2", "right.motor 20"), ("left 3", "left_motor 30")]
        {
            controller.tell(command);
            controller.expect(answer);
        }
        right.kill();
        let _right = motor(&system, "right.motor");
        controller.tell("right 4");
        controller.expect("right.motor 40");
    });
}

#[test]
fn a_process_that_does_not_know_its_component_says_so() {
    let all = "set SCL_COMPONENT to `left_motor` or `right.motor`";
    for (component, expected) in [
        ("", format!("this program is a `motor`: {all}")),
        ("gps", format!("this program is a `motor`, but was started as `gps`: {all}")),
        ("rover.left_motor", format!("but was started as `left_motor` of system `rover`: {all}")),
        ("left_motor,right.motor", format!("but was started as `left_motor` or `right.motor`: {all}")),
    ] {
        let exit = System::new().start_with(MOTORS, &[], &[("SCL_COMPONENT", component)]).wait_for_exit();
        assert!(!exit.status.success() && exit.text().contains(&expected), "{component}: {}", exit.text());
    }
}

#[test]
fn a_component_of_a_kind_runs_once() {
    let system = System::new();
    let _controller = open_with(&system, MOTORS, "controller");
    let left = motor(&system, "left_motor");
    let exit = system.start_with(MOTORS, &[], &[("SCL_COMPONENT", "left_motor")]).wait_for_exit();
    assert!(exit.text().contains("component `left_motor` cannot be opened"), "{}", exit.text());
    assert!(exit.text().contains(&left.id().to_string()), "{}", exit.text());
}
