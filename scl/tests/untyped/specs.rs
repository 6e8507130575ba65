//! An untyped component knows exactly what a generated one does.

use super::system_plan;
use scl::OpenOptions;
use scl::plan::Plan;
use scl::private::Component as Generated;
use scl::transport::memory::Memory;
use scl::untyped::Component;

mod rover {
    scl::topology!("doc/rover.yaml");
}

#[track_caller]
fn assert_same<C: Generated>(file: &str) {
    let plan = system_plan(file).component(C::SPEC.name).unwrap().clone();
    // Also after it was written and read.
    for plan in [&plan, &Plan::from_json(&plan.to_json()).unwrap()] {
        let options = OpenOptions::new().transport(Memory::new());
        let untyped = Component::open_blocking_with(plan, options).unwrap();
        assert_eq!(format!("{:#?}", untyped.spec()), format!("{:#?}", C::SPEC));
    }
}

#[test]
fn specifications_are_equal() {
    assert_same::<super::Sensor>("untyped.yaml");
    assert_same::<super::Controller>("untyped.yaml");
    assert_same::<super::Logger>("untyped.yaml");
    assert_same::<rover::Sensor>("doc/rover.yaml");
    assert_same::<rover::Controller>("doc/rover.yaml");
    assert_same::<rover::Recorder>("doc/rover.yaml");
    assert_same::<rover::UserInterface>("doc/rover.yaml");
}

#[test]
fn counterparts_are_equal() {
    let (sensor, controller) = (system_plan("untyped.yaml"), system_plan("untyped.yaml"));
    for (plan, generated) in [
        (sensor.component("sensor").unwrap().counterpart(), super::SensorPeer::SPEC),
        (controller.component("controller").unwrap().counterpart(), super::ControllerPeer::SPEC),
    ] {
        let untyped = Component::open_blocking_with(&plan, OpenOptions::new().transport(Memory::new())).unwrap();
        assert_eq!(format!("{:#?}", untyped.spec()), format!("{generated:#?}"));
    }
}
