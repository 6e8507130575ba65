//! `scl metrics`, read by Prometheus itself.

use crate::client::{request, start_server};
use crate::rover::Rover;
use crate::system::{ChildGuard, SpawnGuarded};
use scl_needs::needs;
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Output, Stdio};

fn promtool(arguments: &[&str], input: &str) -> Output {
    let mut command = Command::new("promtool");
    let command = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut process = command.spawn_guarded();
    process.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    process.wait_with_output()
}

/// Starts a Prometheus that asks this address once a second. Returns its own address.
fn start_prometheus(rover: &Rover, target: &str) -> (ChildGuard, String) {
    rover.write(
        "prometheus.yaml",
        &format!(
            "global: {{scrape_interval: 1s}}\nscrape_configs: [{{job_name: scl, static_configs: [{{targets: ['{target}']}}]}}]\n"
        ),
    );
    let mut command = Command::new("prometheus");
    command.arg(format!("--config.file={}", rover.path("prometheus.yaml").display()));
    command.arg(format!("--storage.tsdb.path={}", rover.path("prometheus").display()));
    let mut process = command.arg("--web.listen-address=127.0.0.1:0").stderr(Stdio::piped()).spawn_guarded();
    let mut lines = BufReader::new(process.stderr.take().unwrap()).lines().map(Result::unwrap);
    let line = lines.find(|line| line.contains("Listening on")).unwrap();
    let address = line.rsplit_once("address=").unwrap().1.trim().to_owned();
    // It must not stop at a full pipe.
    std::thread::spawn(move || lines.for_each(drop));
    (process, address)
}

#[needs("prometheus", "promtool")]
#[test]
fn prometheus_reads_the_figures_and_answers_the_queries_of_the_dashboard() {
    let rover = Rover::start();
    let (_server, address, _) = start_server(rover.scl(&["metrics", "--listen", "127.0.0.1:0"]));
    let checked = promtool(&["check", "metrics"], &request(&address, "GET", "/metrics", &address, "").text());
    assert!(checked.status.success() && checked.stderr.is_empty(), "{}", String::from_utf8_lossy(&checked.stderr));

    let (_prometheus, own) = start_prometheus(&rover, &address);
    let server = format!("http://{own}");
    let dashboard: Value = serde_json::from_str(&rover.text(&["metrics", "--dashboard"])).unwrap();
    let panels = dashboard["panels"].as_array().unwrap();
    for query in panels.iter().flat_map(|panel| panel["targets"].as_array().unwrap()) {
        let query = query["expr"].as_str().unwrap();
        let values = [("$system", "rover"), ("$component", ".*"), ("$__rate_interval", "10s")];
        let query = values.iter().fold(query.to_owned(), |query, (name, value)| query.replace(name, value));
        // Those that compare show only what is wrong.
        let shows_all = !query.contains(" > 0") && !query.contains(" == 0");
        loop {
            let answer = promtool(&["query", "instant", &server, &query], "");
            assert!(answer.status.success(), "{query}: {}", String::from_utf8_lossy(&answer.stderr));
            if !shows_all || !answer.stdout.is_empty() {
                break;
            }
        }
    }
}
