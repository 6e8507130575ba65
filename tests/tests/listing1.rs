//! The paper's Listing 1, byte for byte: four programs over Unix sockets and TCP, in every start order.

use crate::programs::LISTING1;
use scl_tests::{Process, System, on_each_transport};

const COMPONENTS: [&str; 4] = ["sensor", "actuator", "controller", "user_interface"];

#[test]
fn four_programs_talk() {
    on_each_transport(|system| {
        let mut actuator = system.start(LISTING1, &["actuator"]);
        let mut user_interface = system.start(LISTING1, &["user_interface"]);
        let _controller = system.start(LISTING1, &["controller"]);
        let mut sensor = system.start(LISTING1, &["sensor"]);
        sensor.expect("sent");
        actuator.expect("set to b\"measured\"");
        user_interface.expect("status b\"done\", event b\"faster\"");
        assert!(user_interface.wait_for_exit().status.success());
    });
}

#[test]
fn four_programs_talk_in_every_start_order() {
    for order in permutations() {
        let system = System::new();
        let mut started: Vec<(usize, Process)> =
            order.iter().map(|&index| (index, system.start(LISTING1, &[COMPONENTS[index]]))).collect();
        started.sort_by_key(|(index, _)| *index);
        started[0].1.expect("sent");
        started[1].1.expect("set to b\"measured\"");
        started[3].1.expect("status b\"done\", event b\"faster\"");
    }
}

/// All 24 permutations of four.
fn permutations() -> Vec<[usize; 4]> {
    let all = (0..256).map(|code| [code / 64, code / 16 % 4, code / 4 % 4, code % 4]);
    let permutations: Vec<[usize; 4]> = all.filter(|order| (0..4).all(|index| order.contains(&index))).collect();
    assert_eq!(permutations.len(), 24);
    permutations
}
