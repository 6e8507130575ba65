//! A file that becomes two groups: one program for the same component of both.

use crate::programs::ARMS;
use scl_tests::{Process, System, on_each_transport};

fn start(system: &System, part: &str, component: &str) -> Process {
    system.start_with(ARMS, &[part], &[("SCL_COMPONENT", component)])
}

#[test]
fn each_group_works_by_itself() {
    on_each_transport(|system| {
        let mut pilot = start(&system, "pilot", "arms.pilot");
        let parts = [
            ("planner", "left_arm.planner"),
            ("driver", "left_arm.driver"),
            ("planner", "right_arm.planner"),
            ("driver", "right_arm.driver"),
        ];
        let mut started = parts.map(|(part, component)| start(&system, part, &format!("arms.{component}")));
        for (process, (_, component)) in started.iter_mut().zip(parts) {
            process.expect(component);
        }
        pilot.expect("ready");
        for (command, answer) in [("left 1", "left_arm.driver 11"), ("right 2", "right_arm.driver 21")] {
            pilot.tell(command);
            pilot.expect(answer);
        }
        // The other arm does not notice that a part of this one is killed.
        let [_, left_driver, ..] = started;
        left_driver.kill();
        pilot.tell("right 3");
        pilot.expect("right_arm.driver 31");
        let mut left_driver = start(&system, "driver", "left_arm.driver");
        left_driver.expect("left_arm.driver");
        pilot.tell("left 4");
        pilot.expect("left_arm.driver 41");
    });
}
