//! Components that need more than their transport offers are refused, with gate, option and guarantee.
#![allow(clippy::unwrap_used)]

use crate::conformance_memory::Declared;
use crate::untyped::system_plan;
use scl::transport::memory::Memory;
use scl::transport::{Guarantee, Guarantees};
use scl::untyped::Component;
use scl::{OpenError, OpenOptions};

fn open(component: &str, declares: Guarantees) -> Result<(), OpenError> {
    let system = system_plan("guarantees.yaml");
    let options = OpenOptions::new().transport(Declared { memory: Memory::new(), declares });
    Component::open_blocking_with(system.component(component).unwrap(), options).map(drop)
}

#[test]
fn what_is_missing_is_named_with_the_gate_that_needs_it() {
    let cases = [
        (
            "sensor",
            "component `sensor` needs more than its transport offers: gate `sensor.samples` (`backpressure: true`) needs \
             senders that wait instead of dropping messages; gate `sensor.samples` (`backpressure: true`) needs \
             acknowledgements of the messages that were taken; gate `sensor.calibrate` (`rep`) needs requests and replies; \
             choose another transport",
        ),
        (
            "recorder",
            "component `recorder` needs more than its transport offers: gate `recorder.samples` (`when_full: wait`) needs \
             senders that wait instead of dropping messages; choose another transport",
        ),
        (
            "controller",
            "component `controller` needs more than its transport offers: gate `controller.position` (`queue: 1`) needs the \
             newest message, also after a pause; gate `controller.calibrate` (`req`) needs requests and replies; choose \
             another transport",
        ),
    ];
    for (component, expected) in cases {
        assert_eq!(open(component, Guarantees::NONE).unwrap_err().to_string(), expected);
        open(component, Guarantees::ALL).unwrap();
    }
}

/// Each need is one guarantee: with all others a component is refused, and what nobody needs is not asked for.
#[test]
fn each_guarantee_is_needed_where_it_is_declared() {
    let needs = [
        ("sensor", vec![Guarantee::Acknowledgement, Guarantee::Waiting, Guarantee::Requests]),
        ("recorder", vec![Guarantee::Waiting]),
        ("controller", vec![Guarantee::Freshness, Guarantee::Requests]),
        ("logger", vec![]),
    ];
    for (component, needs) in needs {
        open(component, needs.iter().copied().collect()).unwrap();
        for guarantee in Guarantee::ALL {
            let opened = open(component, Guarantees::ALL.without(guarantee));
            assert_eq!(opened.is_err(), needs.contains(&guarantee), "{component} without {guarantee:?}: {opened:?}");
        }
    }
}

#[test]
fn sets_of_guarantees_contain_what_was_added() {
    let set = Guarantees::NONE.with(Guarantee::Freshness).with(Guarantee::Freshness).with(Guarantee::Requests);
    assert_eq!(format!("{set:?}"), "{Freshness, Requests}");
    assert_eq!(set, [Guarantee::Requests, Guarantee::Freshness].into_iter().collect());
    assert_eq!(set.without(Guarantee::Freshness).without(Guarantee::Requests), Guarantees::NONE);
    assert_eq!(Guarantee::ALL.into_iter().collect::<Guarantees>(), Guarantees::ALL);
}
