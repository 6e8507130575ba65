//! Programs without generated code, with typed ones and with each other: they exchange everything, and refuse each
//! other for the same reasons and in the same words.

use crate::programs::{SHAPES, UNTYPED};
use crate::shapes::{answer, assert_names, exchange};
use scl_tests::{Process, System, on_each_transport};
use std::path::Path;

/// How a program was built, from which of the topologies in `topologies/shapes`.
#[derive(Clone, Copy, Debug)]
enum Program {
    Typed(&'static str),
    Untyped(&'static str),
}
use Program::{Typed, Untyped};

/// The promise: what an untyped component sends and receives is what a typed one does, in all patterns and both
/// directions.
#[test]
fn typed_and_untyped_programs_exchange_everything() {
    on_each_transport(|system| {
        for (sensor, viewer) in [
            (Untyped("original"), Typed("original")),
            (Typed("original"), Untyped("original")),
            (Untyped("original"), Untyped("original")),
            (Untyped("original"), Typed("extended")),
        ] {
            let (mut sensor, mut viewer) = (start(&system, sensor, "sensor"), start(&system, viewer, "viewer"));
            exchange(&mut sensor, &mut viewer);
            sensor.kill();
            viewer.kill();
        }
    });
}

/// The promise: peers reconnect after either side was killed and started again.
#[test]
fn a_killed_program_is_found_again() {
    let system = System::new();
    let mut sensor = start(&system, Untyped("original"), "sensor");
    let mut viewer = start(&system, Typed("original"), "viewer");
    exchange(&mut sensor, &mut viewer);
    viewer.kill();
    let mut viewer = start(&system, Untyped("original"), "viewer");
    exchange(&mut sensor, &mut viewer);
    sensor.kill();
    let mut sensor = start(&system, Typed("original"), "sensor");
    exchange(&mut sensor, &mut viewer);
}

/// The promise: swapped field numbers and other types are refused on both sides, which name both.
#[test]
fn other_messages_are_refused_by_name_on_both_sides() {
    let swapped: [&str; 3] = ["nav.Position", "`lat`", "`lon`"];
    let renamed: [&str; 2] = ["nav.Position", "nav.Location"];
    on_each_transport(|system| {
        for (sensor, viewer, words) in [
            (Untyped("original"), Typed("swapped"), &swapped[..]),
            (Typed("original"), Untyped("swapped"), &swapped),
            (Untyped("swapped"), Untyped("original"), &swapped),
            (Untyped("original"), Typed("renamed"), &renamed),
            (Typed("original"), Untyped("renamed"), &renamed),
            (Untyped("renamed"), Untyped("original"), &renamed),
        ] {
            let (mut sensor, mut viewer) = (start(&system, sensor, "sensor"), start(&system, viewer, "viewer"));
            let (sensor_id, viewer_id) = (sensor.id().to_string(), viewer.id().to_string());
            assert_names(&answer(&mut viewer, "ready 300"), &[words, &["sensor", &sensor_id]].concat());
            assert_names(&answer(&mut sensor, "ready 300"), &[words, &["viewer", &viewer_id]].concat());
            assert_names(&answer(&mut sensor, "call"), &[words, &["viewer", &viewer_id]].concat());
            sensor.kill();
            viewer.kill();
        }
    });
}

/// The promise: a component runs once, whichever way it is opened, and the error names the process that runs it.
#[test]
fn a_component_runs_once() {
    for (first, second) in [(Typed("original"), Untyped("original")), (Untyped("original"), Typed("original"))] {
        let system = System::new();
        let running = start(&system, first, "sensor");
        let refused = begin(&system, second, "sensor").wait_for_exit();
        assert!(!refused.status.success(), "{refused:?}");
        let told = refused.output.into_iter().chain(refused.log).collect::<Vec<_>>().join("\n");
        assert_names(&told, &["`sensor`", "already running", &running.id().to_string()]);
    }
}

/// The promise: what is wrong with a plan is told before anything is opened.
#[test]
fn a_wrong_plan_opens_nothing() {
    let system = System::new();
    let text = std::fs::read_to_string(plan_file(&system, "original")).expect("the plan");
    for (from, to, words) in [
        ("\"version\": 1", "\"version\": 9", "version 9"),
        ("\"kind\": \"pub\"", "\"kind\": \"pup\"", "components[0].gates[0].kind"),
        ("\"name\": \"sensor\"", "\"name\": \"sender\"", "no component `sensor`; did you mean `sender`?"),
    ] {
        let file = system.runtime_dir().join("wrong.json");
        std::fs::write(&file, text.replacen(from, to, 1)).expect("a file for the plan");
        let refused = system.start(UNTYPED, &[&file.to_string_lossy(), "sensor"]).wait_for_exit();
        assert!(!refused.status.success() && refused.output.concat().contains(words), "{refused:?}");
    }
    assert!(!system.runtime_dir().join("shapes").exists(), "the system's folder was created");
}

fn start(system: &System, program: Program, component: &str) -> Process {
    let mut process = begin(system, program, component);
    process.expect("open");
    process
}

fn begin(system: &System, program: Program, component: &str) -> Process {
    match program {
        Typed(variant) => system.start(SHAPES, &[variant, component]),
        Untyped(variant) => system.start(UNTYPED, &[&plan_file(system, variant), component]),
    }
}

/// What `scl plan` prints for a topology, in a file.
fn plan_file(system: &System, variant: &str) -> String {
    let topology = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("topologies/shapes/{variant}.yaml"));
    let loaded = scl_loader::load(&scl_loader::Request::new(topology));
    let plan = loaded.system_plan().unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
    let file = system.runtime_dir().join(format!("{variant}.json"));
    std::fs::write(&file, plan.to_json()).expect("a file for the plan");
    file.to_string_lossy().into_owned()
}
