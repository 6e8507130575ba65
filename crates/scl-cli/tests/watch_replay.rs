//! `scl watch --replay`: a recording, with a position for each page.

use crate::client::Watch;
use crate::rover::Rover;
use serde_json::{Map, Value};

/// A recording of the rover, and the page over it.
fn replayed() -> (Rover, Watch) {
    let rover = Rover::start();
    let output = rover.scl(&["record", "--for", "3s", "-o", "flight.mcap"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let watch = Watch::start(rover.scl(&["watch", "--replay", "flight.mcap"]));
    (rover, watch)
}

/// What a page knows at a position.
fn at(watch: &Watch, seconds: f64) -> Map<String, Value> {
    let Value::Object(known) = watch.events(&format!("view=1&from={seconds}&speed=0")).next("state") else {
        panic!("a state is an object")
    };
    known
}

#[test]
fn a_position_has_the_rates_and_messages_of_its_time() {
    let (_rover, watch) = replayed();
    let known = at(&watch, 2.0);
    assert_eq!(known["time"]["at"], 2.0);
    let length = known["time"]["length"].as_f64().unwrap();
    assert!((2.0..60.0).contains(&length), "{length}");
    let rates = known.iter().filter(|(name, _)| name.starts_with("row ")).map(|(_, row)| row["perSecond"].as_f64());
    assert!(rates.flatten().any(|rate| rate > 0.0));
    assert!(known.iter().any(|(name, edge)| name.starts_with("edge ") && edge["flow"] == "messages"));
    assert!(known.iter().filter(|(name, _)| name.starts_with("block ")).all(|(_, block)| block["state"].is_null()));
    assert_eq!(known["component sensor"]["activity"], "recorded");
    assert_eq!(at(&watch, 1e9)["time"]["at"], length);

    let shown =
        |gate: &str, from: f64| watch.events(&format!("gate={gate}&from={from}&speed=0&field=count")).next("gate");
    let (early, late) = (shown("sensor.measurements", 0.5), shown("sensor.measurements", 2.0));
    assert!(early["time"].as_f64().unwrap() < late["time"].as_f64().unwrap());
    assert!(!late["points"].as_array().unwrap().is_empty(), "{late}");
    // A gate that receives shows what its peers have sent.
    let received = shown("controller.sensor", 2.0);
    assert_eq!(received["text"], late["text"]);
    let calls = shown("controller.commands", 2.0);
    assert!(["request", "reply"].contains(&calls["calls"][0]["kind"].as_str().unwrap()), "{calls}");
}

#[test]
fn a_page_plays_to_the_end() {
    let (_rover, watch) = replayed();
    let mut events = watch.events("view=0&from=0.5&speed=5");
    let mut positions = Vec::new();
    loop {
        let state = events.next("state");
        let time = &state["time"];
        positions.push(time["at"].as_f64().unwrap());
        if time["at"] == time["length"] {
            break;
        }
    }
    assert!(positions.is_sorted() && positions[0] >= 0.5, "{positions:?}");
}

#[test]
fn a_recording_that_is_removed_meanwhile_is_explained() {
    let (rover, watch) = replayed();
    std::fs::remove_file(rover.path("flight.mcap")).unwrap();
    let state = watch.events("view=0").next("state");
    assert!(state["problems"][0].as_str().unwrap().contains("cannot read `flight.mcap`"), "{state}");
}

#[test]
fn what_is_no_recording_of_a_system_is_explained() {
    let rover = Rover::stopped();
    assert!(rover.error(&["watch", "--replay", "flight.mcap"], 2).contains("`flight.mcap`"));
    let error = rover.error(&["watch", "--replay", "topology.yaml"], 2);
    assert!(error.contains("`topology.yaml` is not a recording"), "{error}");
    let error = rover.error(&["watch", "--replay", "flight.mcap", "--control"], 2);
    assert!(error.contains("cannot be used with"), "{error}");
}
