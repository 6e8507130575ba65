//! `scl watch`: the logs of components, and what a page with `--control` does.

use crate::client::{Response, Watch, request};
use crate::parameters;
use crate::rover::Rover;
use crate::system::{FOREVER, System};
use serde_json::{Value, json};
use std::fs::OpenOptions;
use std::io::Write;

/// Posts an action.
fn post(watch: &Watch, action: &Value) -> Response {
    watch.post("/actions", &action.to_string())
}

/// What an action did: whether it succeeded, and what was printed.
fn act(watch: &Watch, action: &Value) -> (bool, String) {
    let answer = post(watch, action);
    assert_eq!(answer.status, 200);
    let done: Value = serde_json::from_str(&answer.text()).unwrap();
    (done["done"].as_bool().unwrap(), done["text"].as_str().unwrap().to_owned())
}

#[test]
fn the_log_of_a_component_is_shown_and_followed() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let mut events = watch.events("component=sensor");
    let error = events.next("log")["error"].as_str().unwrap().to_owned();
    assert!(error.contains("there is no log of component `sensor`"), "{error}");

    let line = |text: &str| {
        let entry = json!({
            "time": "2026-12-01T00:00:00Z", "component": "sensor", "stream": "stdout", "run": 1, "text": text,
        });
        format!("{entry}\n")
    };
    std::fs::create_dir_all(rover.path("state/scl/rover")).unwrap();
    rover.write("state/scl/rover/sensor.log", &line("earlier <b>"));
    let lines =
        |shown: &Value| shown["lines"].as_array().map(|lines| lines.iter().map(Value::to_string).collect::<String>());
    let mut next = || loop {
        if let Some(lines) = lines(&events.next("log")) {
            return lines;
        }
    };
    assert!(next().contains("stdout earlier <b>"));
    let mut file = OpenOptions::new().append(true).open(rover.path("state/scl/rover/sensor.log")).unwrap();
    file.write_all(line("later").as_bytes()).unwrap();
    assert!(next().contains("stdout later"));
}

#[test]
fn a_page_acts_only_with_control() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let stop = json!({"action": "stop", "component": "sensor"});
    let answer = post(&watch, &stop);
    assert_eq!(answer.status, 405);
    assert!(answer.text().contains("`scl watch --control` lets pages act"));
    assert!(watch.get("/").text().contains("data-controls=\"\""));

    let watch = Watch::start(rover.scl(&["watch", "--control"]));
    assert!(watch.get("/").text().contains("data-controls=\"actions\""));
    let refused = |action: Value| {
        let answer = post(&watch, &action);
        assert_eq!(answer.status, 400);
        answer.text()
    };
    assert!(refused(json!({"action": "remove", "component": "sensor"})).contains("unknown variant `remove`"));
    assert!(refused(json!({"action": "stop"})).contains("missing field `component`"));
    assert!(refused(json!([])).contains("not an action"));
    assert_eq!(post(&watch, &json!({"action": "call", "gate": "x".repeat(2 << 20), "request": ""})).status, 413);
    assert_eq!(watch.post("/", "").status, 405);
    let without_token = request(&watch.address, "POST", "/actions", &watch.address, &stop.to_string());
    assert_eq!(without_token.status, 403);

    // What looks like an option is a name.
    let (done, text) = act(&watch, &json!({"action": "stop", "component": "--help"}));
    assert!(!done && text.contains("no `scl run` is running"), "{text}");
}

#[test]
fn a_page_sets_parameters_and_calls_gates() {
    let mut rover = parameters::rover();
    let watch = Watch::start(rover.scl(&["watch", "--control"]));
    let set = |value: &str| act(&watch, &json!({"action": "set", "parameter": "controller.gain", "value": value}));
    assert_eq!(set("2"), (true, "controller.gain: 0.8 -> 2\n".to_owned()));
    let (done, text) = set("fast");
    assert!(!done && text.contains("wrong value of `controller.gain`"), "{text}");

    let (done, template) = act(&watch, &json!({"action": "template", "gate": "controller.commands"}));
    assert!(done && template.contains("target_speed:"), "{template}");
    let call = || act(&watch, &json!({"action": "call", "gate": "controller.commands", "request": template}));
    let (done, text) = call();
    assert!(!done && text.contains("every requester of `controller.commands` is running"), "{text}");
    rover.stop("user_interface");
    let (done, text) = call();
    assert!(done && text.contains("accepted:"), "{text}");
}

#[test]
fn a_page_restarts_and_stops_components() {
    let topology = "system: rover\ncomponents: [{name: sensor}]\nconnections: []\n";
    let launch = format!("components: {{sensor: {{command: {:?}}}}}\n", format!("echo started; {FOREVER}"));
    let system = System::of_files(&[("topology.yaml", topology), ("launch.yaml", &launch)]);
    let mut run = system.start(&[]);
    run.wait_for_line("sensor | started");
    let watch = Watch::start(system.scl(&["watch", "--control", "--system", "rover"]));
    let (done, text) = act(&watch, &json!({"action": "restart", "component": "sensor"}));
    assert!(done && text.starts_with("sensor  running as process "), "{text}");
    let (done, text) = act(&watch, &json!({"action": "stop", "component": "sensor"}));
    assert!(done && text.starts_with("sensor  stopped"), "{text}");
}
