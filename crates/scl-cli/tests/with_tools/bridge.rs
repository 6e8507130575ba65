//! `scl bridge`, read by libzmq.

use crate::rover::Rover;
use crate::system::SpawnGuarded;
use scl_tests::python_with_packages;
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// Subscribes to some topics, and prints the first message of each.
const SUBSCRIBER: &str = r#"
import json, sys, zmq
socket = zmq.Context().socket(zmq.SUB)
socket.connect(sys.argv[1])
topics = set(sys.argv[2:])
for topic in topics:
    socket.subscribe(topic)
while topics:
    topic, message, time = (frame.decode() for frame in socket.recv_multipart())
    if topic in topics:
        topics.remove(topic)
        print(json.dumps({"topic": topic, "message": json.loads(message), "time": float(time)}), flush=True)
"#;

#[test]
fn pyzmq_reads_topics_messages_and_times() {
    let rover = Rover::start();
    let mut bridge = rover.scl(&["bridge", "plotjuggler", "--listen", "tcp://127.0.0.1:0"]);
    let mut bridge = bridge.stdout(Stdio::piped()).spawn_guarded();
    let mut address = String::new();
    BufReader::new(bridge.stdout.take().unwrap()).read_line(&mut address).unwrap();
    let topics = ["/sensor/measurements", "/controller/commands/request", "/controller/commands/reply"];
    let mut reader = Command::new(python_with_packages());
    let output = reader.args(["-c", SUBSCRIBER, address.trim()]).args(topics).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs_f64();
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        let read: Value = serde_json::from_str(line).unwrap();
        let field = match read["topic"].as_str().unwrap() {
            "/sensor/measurements" => "speed",
            "/controller/commands/request" => "target_speed",
            _ => "accepted",
        };
        assert!(!read["message"][field].is_null(), "{read}");
        let time = read["time"].as_f64().unwrap();
        assert!(time <= now && time > now - 600.0, "{read}");
    }
}

#[test]
fn an_address_in_use_is_explained() {
    let rover = Rover::start();
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("tcp://{}", listener.local_addr().unwrap());
    let error = rover.error(&["bridge", "plotjuggler", "--listen", &address], 2);
    assert!(error.contains(&format!("cannot listen at {address}")), "{error}");
    let error = rover.error(&["bridge", "plotjuggler", "sensor.measurement"], 2);
    assert!(error.contains("did you mean `sensor.measurements`?"), "{error}");
}
