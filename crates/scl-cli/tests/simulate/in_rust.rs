//! Simulations in tests in Rust.

use super::scenarios::{play, system};
use scl::codec::Json;
use scl_simulate::{Simulation, SimulationError};
use serde_json::Value;
use std::time::Duration;

#[test]
fn a_test_reads_what_a_simulation_has_recorded() {
    if play() {
        return;
    }
    let test = "simulate::in_rust::a_test_reads_what_a_simulation_has_recorded";
    let scenario = "faults: [{at: 1s, kill: display}]\nexpect: [{always: pump.level, where: 'level < 2.1'}]\n";
    let system = system(test, scenario);
    let simulation = Simulation::of(system.path("")).command(env!("CARGO_BIN_EXE_scl"));
    let simulation = simulation.scenario(system.path("rough.yaml")).seed(7);
    let run = simulation.clone().until(Duration::from_secs(2)).run().unwrap();

    let messages = run.messages_in::<Json, Value>("pump.level").unwrap();
    assert!(messages.len() >= 19, "{messages:?}");
    assert!(messages.is_sorted_by_key(|(at, _)| *at));
    let (at, last) = run.last_in::<Json, Value>("pump.level").unwrap();
    assert!((last["level"].as_f64().unwrap() - at.as_secs_f64()).abs() < 0.01, "{last:?} at {at:?}");
    assert!(run.printed().contains("display"), "{}", run.printed());
    assert!(run.log().contains("fault 1, at 1.000000 s: `display` is killed"), "{}", run.log());
    assert!(run.recording().is_file());

    let error = run.last_in::<Json, Value>("pump.levels").unwrap_err();
    assert_eq!(error.to_string(), "gate `pump.levels` has no message; those that have some: `pump.level`");
    assert!(run.messages_in::<Json, Value>("pump.levels").unwrap().is_empty());
    let error = run.last::<()>("pump.level").unwrap_err();
    assert_eq!(error.to_string(), "the messages of `pump.level` have the codec `json`, not `protobuf`");
    let error = run.last_in::<Json, u8>("pump.level").unwrap_err();
    assert!(error.to_string().starts_with("the message of `pump.level` at "), "{error}");

    // What the scenario expects does not happen.
    let error = simulation.until(Duration::from_secs(3)).run().unwrap_err();
    assert!(matches!(&error, SimulationError::Failed { .. }), "{error}");
    assert!(error.to_string().contains("`pump.level` does not always meet its condition"), "{error}");
    let error = Simulation::of(".").command("no-such-scl").run().unwrap_err();
    assert!(error.to_string().starts_with("cannot start `no-such-scl`: No such file"), "{error}");
}
