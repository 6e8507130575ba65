//! Replays whose gates have several peers, or a peer that leaves and comes again.

use super::{HANG_LIMIT, LOG, MEASUREMENTS, ROVER, Rover, text};

#[test]
fn a_peer_that_has_lost_messages_and_come_again_is_a_failure_without_a_limit_of_speed() {
    let rover = Rover::new();
    let numbers: Vec<String> = (0..1000).map(|number| number.to_string()).collect();
    rover.record("flight.mcap", &numbers.iter().map(|number| (MEASUREMENTS, 0, &**number)).collect::<Vec<_>>());
    let open = || {
        let mut controller = rover.open("controller");
        let gates = ["newest", "history"].map(|name| controller.subscriber(name).unwrap());
        (controller, gates)
    };
    let (controller, [newest, mut history]) = open();
    let replay = rover.start(&["flight.mcap", "--as", "sensor", "--rate", "max"]);
    for number in &numbers[..2] {
        assert_eq!(text(&history.recv_timeout(HANG_LIMIT).unwrap()), *number);
    }
    // The first of these has been sent to the other gate, too.
    drop((controller, newest, history));
    let (_controller, gates) = open();
    std::thread::scope(|scope| {
        for mut gate in gates {
            scope.spawn(move || while text(&gate.recv_timeout(HANG_LIMIT).unwrap()) != "999" {});
        }
    });
    let output = replay.wait_with_output();
    assert!(text(&output.stdout).contains("it disconnected"), "{output:?}");
    assert_eq!(output.status.code(), Some(1), "{output:?}");
}

#[test]
fn messages_that_peers_share_are_distributed_anew() {
    let mut rover = Rover::new();
    let logger = "  - name: logger\n    gates:\n      - log: {pull: rover.Line, queue: 10}\nconnections:\n  - [sensor.log, logger.log]\n";
    let shared = ROVER.replace("{push: rover.Line}", "{push: rover.Line, share: true}");
    rover.plan = rover.plan_of(&shared.replace("connections:\n", logger));
    rover.record("flight.mcap", &[(LOG, 0, "a"), ("/logger/log", 1, "b"), (LOG, 2, "c"), ("/logger/log", 3, "d")]);
    let mut gates = ["controller", "logger"].map(|name| {
        let mut component = rover.open(name);
        (component.puller("log").unwrap(), component)
    });
    let report = rover.replay_json(&["flight.mcap", "--as", "sensor"]);
    assert_eq!(report["sent"], 4, "{report}");
    let mut received = Vec::new();
    while received.len() < 4 {
        received
            .extend(gates.iter_mut().filter_map(|(gate, _)| gate.try_recv().unwrap()).map(|message| text(&message)));
    }
    received.sort();
    assert_eq!(received, ["a", "b", "c", "d"]);
}

#[test]
fn a_gate_of_several_senders_is_replayed_only_if_all_are_played() {
    let mut rover = Rover::new();
    let gps =
        "  - name: gps\n    gates:\n      - log: {push: rover.Line}\nconnections:\n  - [gps.log, controller.log]\n";
    rover.plan = rover.plan_of(&ROVER.replace("connections:\n", gps));
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1"), (LOG, 1, "a")]);
    let _controller = rover.open("controller");
    let report = rover.replay_json(&["flight.mcap", "--as", "sensor"]);
    let log = report["gates"].as_array().unwrap().iter().find(|gate| gate["recorded"] == "controller.log").unwrap();
    assert_eq!((&log["sent"], &log["skipped"]), (&0.into(), &1.into()), "{report}");
    let reason = log["reason"].as_str().unwrap();
    let expected = "it has several pushers, which the recording does not distinguish, and `gps` ";
    assert!(reason.starts_with(expected), "{reason}");
    assert_eq!(rover.replay_json(&["flight.mcap", "--as", "sensor,gps"])["sent"], 2);
}
