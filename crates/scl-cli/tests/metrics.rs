//! `scl metrics`: what Prometheus gets, of real components.

use crate::client::{request, start_server};
use crate::rover::{COMPONENTS, Rover};
use serde_json::Value;
use std::collections::BTreeSet;

/// The value of a sample, if it is there.
fn sample(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find(|line| line.strip_prefix(name).is_some_and(|rest| rest.starts_with(' ')));
    line.map(|line| line[name.len() + 1..].parse().unwrap())
}

fn wait_for(rover: &Rover, condition: impl Fn(&str) -> bool) -> String {
    loop {
        let text = rover.text(&["metrics"]);
        if condition(&text) {
            return text;
        }
    }
}

#[test]
fn figures_of_components_gates_and_connections_are_told() {
    let mut rover = Rover::start();
    let sent = r#"scl_gate_sent_messages_total{system="rover",component="sensor",gate="measurements"}"#;
    let taken = r#"scl_connection_taken_messages_total{system="rover",component="sensor",gate="measurements",peer="controller.sensor"}"#;
    let is_some = |text: &str, name: &str| sample(text, name).is_some_and(|value| value > 0.0);
    let text = wait_for(&rover, |text| is_some(text, sent) && is_some(text, taken));
    let of_sensor = |name: &str| format!(r#"{name}{{system="rover",component="sensor"}}"#);
    assert!(sample(&text, &of_sensor("scl_component_resident_memory_bytes")).unwrap() > 100_000.0);
    let started = sample(&text, &of_sensor("scl_component_start_time_seconds")).unwrap();
    let written = sample(&text, &of_sensor("scl_component_figures_time_seconds")).unwrap();
    assert!(started > 1.7e9 && written >= started, "{started} {written}");

    // A counter that falls would be taken for a restart.
    let earlier = sample(&text, sent).unwrap();
    wait_for(&rover, |text| {
        assert!(sample(text, sent).unwrap() >= earlier);
        sample(text, sent).unwrap() > earlier
    });

    let state = |text: &str, state: &str| {
        let name = format!(r#"scl_component_state{{system="rover",component="sensor",state="{state}"}}"#);
        sample(text, &name).unwrap()
    };
    wait_for(&rover, |text| state(text, "ready") == 1.0);
    rover.kill("sensor");
    let text = wait_for(&rover, |text| state(text, "dead") == 1.0);
    assert_eq!(state(&text, "ready"), 0.0);
    assert_eq!(sample(&text, &of_sensor("scl_component_start_time_seconds")), None);
}

#[test]
fn figures_are_served_whenever_a_system_starts() {
    let mut rover = Rover::stopped();
    let (_server, address, path) = start_server(rover.scl(&["metrics", "--listen", "127.0.0.1:0"]));
    assert_eq!(path, "metrics");
    let get = |target: &str| request(&address, "GET", target, &address, "");
    let answer = get("/metrics");
    assert_eq!(answer.status, 200);
    assert!(answer.headers.iter().any(|line| line == "content-type: text/plain; version=0.0.4; charset=utf-8"));
    assert!(!answer.text().contains("state=\"ready\"} 1"));
    rover.play(&COMPONENTS, |_| {});
    let is_ready = |text: &str| {
        COMPONENTS.iter().all(|component| {
            let name = format!(r#"scl_component_state{{system="rover",component="{component}",state="ready"}}"#);
            sample(text, &name) == Some(1.0)
        })
    };
    while !is_ready(&get("/metrics").text()) {}
    assert_eq!(get("/").status, 404);
    assert_eq!(request(&address, "POST", "/metrics", &address, "").status, 405);
    // Prometheus may know this machine by any name.
    assert_eq!(request(&address, "GET", "/metrics", "board.example:9464", "").status, 200);

    let error = rover.error(&["metrics", "--listen", &address], 2);
    assert!(error.contains(&format!("cannot listen at {address}")), "{error}");
    assert!(error.contains("= help: choose an address of this machine, with another port"), "{error}");
}

#[test]
fn the_dashboard_asks_for_figures_that_there_are() {
    let rover = Rover::start();
    let text = rover.text(&["metrics"]);
    let told: BTreeSet<&str> =
        text.lines().filter_map(|line| line.strip_prefix("# TYPE ")?.split(' ').next()).collect();
    let dashboard: Value = serde_json::from_str(&rover.text(&["metrics", "--dashboard"])).unwrap();
    let panels = dashboard["panels"].as_array().unwrap();
    let queries = panels.iter().flat_map(|panel| panel["targets"].as_array().unwrap());
    let asked: BTreeSet<String> = queries.flat_map(|query| figures_in(query["expr"].as_str().unwrap())).collect();
    assert!(asked.len() > 5);
    assert!(asked.iter().all(|name| told.contains(name.as_str())), "{asked:?} of {told:?}");
}

/// The names of figures in a query.
fn figures_in(query: &str) -> Vec<String> {
    let words = query.split(|it: char| !it.is_alphanumeric() && it != '_');
    words.filter(|word| word.starts_with("scl_")).map(str::to_owned).collect()
}
