//! What is said about wrong names, kinds, plans and second openings.

use super::{plan, system_plan};
use scl::plan::{Plan, SystemPlan};
use scl::spec::GateKind;
use scl::transport::memory::Memory;
use scl::untyped::{Component, GateError};
use scl::{OpenError, OpenOptions};
use std::error::Error;

fn open(component: &str) -> Component {
    let options = OpenOptions::new().transport(Memory::new());
    Component::open_blocking_with(&plan(component), options).unwrap()
}

#[test]
fn wrong_names_and_kinds_are_corrected() {
    let mut sensor = open("sensor");
    let cases = [
        ("mesurements", "component `sensor` has no gate `mesurements`; did you mean `measurements`?"),
        (
            "display",
            "component `sensor` has no gate `display`; its gates are `measurements`, `work`, `calibrate`, `raw`",
        ),
        ("", "component `sensor` has no gate ``; its gates are `measurements`, `work`, `calibrate`, `raw`"),
        ("work", "gate `sensor.work` is a `push` gate, not a `pub` gate; take it with `pusher`"),
        ("calibrate", "gate `sensor.calibrate` is a `rep` gate, not a `pub` gate; take it with `replier`"),
    ];
    for (name, expected) in cases {
        assert_eq!(sensor.publisher(name).unwrap_err().to_string(), expected);
    }
    // A gate that was asked for in the wrong way is still there.
    sensor.pusher("work").unwrap();
    assert_eq!(sensor.gate("mesurements").unwrap_err().to_string(), cases[0].1);
}

#[test]
fn each_kind_is_taken_in_one_way() {
    let expected: [(&str, GateKind); 8] = [
        ("measurements", GateKind::Pub),
        ("work", GateKind::Push),
        ("calibrate", GateKind::Rep),
        ("raw", GateKind::Pub),
        ("sensor", GateKind::Sub),
        ("work", GateKind::Pull),
        ("calibrate", GateKind::Req),
        ("raw", GateKind::Sub),
    ];
    for (index, (name, kind)) in expected.into_iter().enumerate() {
        let mut component = open(if index < 4 { "sensor" } else { "controller" });
        let taken = [
            component.publisher(name).err(),
            component.subscriber(name).err(),
            component.requester(name).err(),
            component.replier(name).err(),
            component.pusher(name).err(),
            component.puller(name).err(),
        ];
        for (error, asked) in taken.into_iter().zip(GateKind::ALL) {
            match error {
                None => assert_eq!(kind, asked, "{name}"),
                Some(GateError::Kind { found, expected, .. }) => assert_eq!((found, expected), (kind, asked), "{name}"),
                Some(error) => panic!("{name}: {error}"),
            }
        }
        assert!(matches!(component.gate(name), Err(GateError::Taken { .. })));
    }
}

#[test]
fn a_gate_is_taken_once() {
    let mut sensor = open("sensor");
    let first = sensor.publisher("raw").unwrap();
    let expected = "gate `sensor.raw` was already taken; a gate can be taken only once";
    assert_eq!(sensor.publisher("raw").unwrap_err().to_string(), expected);
    drop(first);
    assert_eq!(sensor.gate("raw").unwrap_err().to_string(), expected);
}

#[test]
fn a_plan_that_contradicts_itself_is_refused() {
    type Break = fn(&mut Plan);
    let cases: [(Break, &str); 4] = [
        (|plan| plan.gates[0].options.queue = 0, "gate `sensor.measurements` has a queue of 0 messages"),
        (|plan| plan.gates[2].endpoint = None, "gate `sensor.calibrate` has no endpoint"),
        (|plan| plan.gates[1].name = "raw".to_owned(), "gate `sensor.raw` is declared twice"),
        (|plan| plan.system = String::new(), "component `sensor` belongs to a system without a name"),
    ];
    for (damage, expected) in cases {
        let mut plan = plan("sensor");
        damage(&mut plan);
        let error = Component::open_blocking_with(&plan, OpenOptions::new().transport(Memory::new())).unwrap_err();
        assert_eq!(error.to_string(), "component `sensor` cannot be opened: its plan is wrong");
        assert_eq!(error.source().unwrap().to_string(), expected);
    }
}

/// Names in a plan may come from anywhere, so they must not lead out of the runtime folder.
#[test]
fn names_do_not_lead_out_of_the_runtime_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    type Break = fn(&mut Plan);
    let cases: [Break; 5] = [
        |plan| plan.component = "../sensor".to_owned(),
        |plan| plan.system = "../../rover".to_owned(),
        |plan| plan.gates[0].connections[0].endpoint = "../../endpoint".to_owned(),
        |plan| plan.gates[2].endpoint = Some("/tmp/endpoint".to_owned()),
        |plan| plan.gates[0].tap = Some("a/../../tap".to_owned()),
    ];
    for damage in cases {
        let mut plan = plan("sensor");
        damage(&mut plan);
        let options = OpenOptions::new().runtime_dir(&inner).system(String::new());
        assert!(Component::open_blocking_with(&plan, options).is_err(), "{plan:?}");
        let outside = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
        assert_eq!(outside.collect::<Vec<_>>().as_slice(), std::slice::from_ref(&inner));
    }
}

#[tokio::test]
async fn a_component_is_opened_once() {
    let folder = tempfile::tempdir().unwrap();
    let options = || OpenOptions::new().runtime_dir(folder.path());
    let told = |error: OpenError| format!("{:?}", scl::Error::from(error));
    let untyped = Component::open_with(&plan("sensor"), options()).await.unwrap();
    let again = told(Component::open_with(&plan("sensor"), options()).await.unwrap_err());
    let typed = told(super::Sensor::open_with(options()).await.err().unwrap());
    assert_eq!(again, typed, "the same words");
    assert!(again.contains("`sensor`") && again.contains("already"), "{again}");
    drop(untyped);
    let _typed = super::Sensor::open_with(options()).await.unwrap();
    assert_eq!(told(Component::open_with(&plan("sensor"), options()).await.unwrap_err()), again);
}

#[test]
fn async_components_need_a_runtime() {
    let plan = plan("sensor");
    let mut opening = std::pin::pin!(Component::open(&plan));
    let mut cx = std::task::Context::from_waker(std::task::Waker::noop());
    let std::task::Poll::Ready(Err(error)) = opening.as_mut().poll(&mut cx) else { panic!("opened") };
    assert!(matches!(error, OpenError::NoRuntime { component: "sensor" }), "{error}");
}

/// The example of the documentation, which shows a plan as `scl plan rover.yaml` prints it.
#[test]
fn the_plan_of_the_documentation_is_current() {
    let mut system = system_plan("doc/rover.yaml");
    let places = system
        .components
        .iter_mut()
        .flat_map(|plan| plan.gates.iter_mut().map(|gate| &mut gate.declared_at).chain([&mut plan.declared_at]));
    places.for_each(|place| *place = place.trim_start_matches("doc/").to_owned());
    assert_eq!(SystemPlan::from_json(include_str!("../../doc/rover.json")).unwrap(), system);
}
