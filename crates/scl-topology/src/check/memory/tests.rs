use super::RULE;
use crate::check::testing::{advice, example, rule_example};
use expect_test::expect;

#[test]
fn gates_may_hold_more_than_the_bound() {
    rule_example(
        &RULE,
        expect![[r#"
            error: [SCL1701] the gates of `camera` may hold 6.38GiB, more than `memory: 64MiB` allows
             --> topology.yaml:3:13
              |
            3 |     memory: 64MiB
              |             ^^^^^ the bound
            4 |     gates:
            5 |       - frames: {pub: Image}
              |         ------ 6.38GiB: 100 x 64MiB in queues, 128MiB in flight
              |
              = help: write `max_size: 512KiB` at `detector.frames`; the gates then hold at most 51MiB
              = help: or raise the bound: `memory: 6528MiB`
              = note: messages wait at the sender: `queue` and `max_size` are those of the receiving gate
        "#]],
    );
}

/// A camera with this bound, whose gate `frames` has one subscriber with these options.
fn camera(memory: &str, options: &str) -> String {
    format!(
        "components:
  - {{name: camera, memory: {memory}, gates: [frames: {{pub: Image}}]}}
  - {{name: detector, gates: [frames: {{sub: Image{options}}}]}}
connections:
  - [camera.frames, detector.frames]
"
    )
}

#[test]
fn the_bound_itself_is_allowed() {
    // Ten messages wait, one is written, and a call sends another one.
    let options = ", queue: 10, max_size: 1MiB";
    assert_eq!(advice(&camera("12MiB", options)), "");
    expect!["SCL1701 the gates of `camera` may hold 12MiB, more than `memory: 12287KiB` allows [write `max_size: 512KiB` at `detector.frames`; the gates then hold at most 6MiB | write `queue: 5` at `detector.frames`; the gates then hold at most 7MiB | or raise the bound: `memory: 12MiB`]"].assert_eq(&advice(&camera("12287KiB", options)));
}

#[test]
fn values_that_do_not_fit_are_not_proposed() {
    let told = [
        advice(&camera("100B", "")),
        advice(&camera("70KiB", ", queue: 1000, max_size: 64KiB")),
        advice(&camera("150KiB", ", queue: 1000, max_size: 64KiB")),
        advice(&camera("1GiB", ", queue: 1000000, max_size: 1GiB")),
    ];
    expect![[r#"
        SCL1701 the gates of `camera` may hold 6.38GiB, more than `memory: 100B` allows [or raise the bound: `memory: 6528MiB`]
        SCL1701 the gates of `camera` may hold 62.7MiB, more than `memory: 70KiB` allows [or raise the bound: `memory: 63MiB`]
        SCL1701 the gates of `camera` may hold 62.7MiB, more than `memory: 150KiB` allows [or raise the bound: `memory: 63MiB`]
        SCL1701 the gates of `camera` may hold 1000002GiB, more than `memory: 1GiB` allows [write `max_size: 1KiB` at `detector.frames`; the gates then hold at most 977MiB]"#]].assert_eq(&told.join("\n"));
}

#[test]
fn bounds_have_a_range_and_a_unit() {
    let bounds = ["0B", "-1MiB", "1024GiB", "1025GiB", "64", "64MB", "lots", "unlimited", "[1MiB]", ""];
    let told: String = bounds
        .iter()
        .map(|bound| format!("{bound}: {}\n", advice(&camera(bound, ", queue: 1, max_size: 8MiB"))))
        .collect();
    expect![[r#"
        0B: SCL0409 `memory` must be at least 1B [without it, the component has no bound]
        -1MiB: SCL0409 `memory` must be at least 1B [without it, the component has no bound]
        1024GiB: 
        1025GiB: SCL0409 `memory` must be at most 1024GiB [the largest is `memory: 1024GiB` | without it, the component has no bound]
        64: SCL0215 `memory` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` [write `memory: 64MiB`]
        64MB: SCL0215 `memory` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` [write `memory: 64MiB`]
        lots: SCL0215 `memory` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` [allowed: 1B to 1024GiB (units: `B`, `KiB`, `MiB`, `GiB`)]
        unlimited: SCL0215 `memory` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` [without `memory`, a component has no bound; the largest is `memory: 1024GiB`]
        [1MiB]: SCL0215 `memory` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` [allowed: 1B to 1024GiB (units: `B`, `KiB`, `MiB`, `GiB`)]
        : SCL0110 the value of `memory` is empty [a value follows the colon | remove `memory`]
    "#]].assert_eq(&told);
}

#[test]
fn components_of_a_kind_share_a_bound_unless_they_have_one() {
    example(
        RULE.code,
        "kinds:
  - name: motor
    memory: 1MiB
    gates:
      - setpoint: {sub: Setpoint, max_size: 4KiB}
      - state: {pub: State}
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor}
  - {name: tail_motor, kind: motor, memory: 2MiB}
  - name: controller
    memory: 16MiB
    gates:
      - setpoints: {pub: Setpoint}
      - states: {sub: State, max_size: 1KiB}
connections:
  - [controller.setpoints, each motor.setpoint]
  - [each motor.state, controller.states]
",
        expect![[r#"
            error: [SCL1701] the gates of `left_motor` may hold 1.56MiB, more than `memory: 1MiB` allows
             --> topology.yaml:3:13
              |
            3 |     memory: 1MiB
              |             ^^^^ the bound
            4 |     gates:
            5 |       - setpoint: {sub: Setpoint, max_size: 4KiB}
              |         -------- 1.4MiB: 100 x 4KiB in queues, 1.01MiB in flight
            6 |       - state: {pub: State}
              |         ----- 165KiB: 100 x 1KiB in queues, 65KiB in flight
              |
              = help: write `queue: 1` at `each motor.setpoint`, `controller.states`; the gates then hold at most 43KiB
              = help: or raise the bound: `memory: 2MiB`
              = note: messages wait at the sender: `queue` and `max_size` are those of the receiving gate
              = note: 2 of the 3 components of the kind have it: `left_motor`, `right_motor`
        "#]],
    );
}

#[test]
fn the_gates_that_hold_most_are_named() {
    example(
        RULE.code,
        "components:
  - name: arm
    memory: 32MiB
    gates:
      - joints: {pub: Joints, latched: true}
      - jobs: {pull: Job, max_size: 1MiB}
      - plan: {req: Goal -> Path, max_size: 2MiB}
      - grip: {rep: Grip -> Done}
      - pose: {sub: Pose, queue: 1, max_size: 1KiB}
  - name: planner
    gates:
      - joints: {sub: Joints, queue: 10, max_size: 1MiB}
      - jobs: {push: Job}
      - plan: {rep: Goal -> Path, max_size: 1MiB}
      - pose: {pub: Pose}
  - name: hand
    gates:
      - grip: {req: Grip -> Done}
connections:
  - [arm.joints, planner.joints]
  - [planner.jobs, arm.jobs]
  - [arm.plan, planner.plan]
  - [hand.grip, arm.grip]
  - [planner.pose, arm.pose]
",
        expect![[r#"
            error: [SCL1701] the gates of `arm` may hold 379MiB, more than `memory: 32MiB` allows
             --> topology.yaml:3:13
              |
            3 |     memory: 32MiB
              |             ^^^^^ the bound
            4 |     gates:
            5 |       - joints: {pub: Joints, latched: true}
              |         ------ 13MiB: 10 x 1MiB in queues, 2MiB in flight, 1MiB latched
            6 |       - jobs: {pull: Job, max_size: 1MiB}
              |         ---- 102MiB: 100 x 1MiB in queues, 2MiB in flight
            7 |       - plan: {req: Goal -> Path, max_size: 2MiB}
            8 |       - grip: {rep: Grip -> Done}
              |         ---- 258MiB in flight
              |
              = help: write `max_size: 128KiB` at `arm.jobs`, `arm.plan`, `arm.grip`, `planner.joints`, `planner.plan`, `hand.grip`; the gates then hold at most 18.7MiB
              = help: or raise the bound: `memory: 379MiB`
              = note: 2 other gates may hold 6.29MiB
              = note: messages wait at the sender: `queue` and `max_size` are those of the receiving gate
        "#]],
    );
}
