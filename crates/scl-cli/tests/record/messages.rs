//! What is in a recording: every message with its times and number, requests with their replies, attachments, totals.

use super::recorder::{Recorder, counts, figures, messages, sequences, summary};
use super::source::Source;
use crate::rover::Rover;
use scl_plan::SystemPlan;
use scl_tests::{wait_for, wait_until};
use std::collections::BTreeMap;
use std::thread;
use std::time::{Duration, SystemTime};

#[test]
fn ten_gates_at_a_thousand_messages_a_second_are_recorded_completely() {
    const COUNT: u64 = 3000;
    let gates: Vec<String> = (0..10).map(|number| format!("g{number}")).collect();
    let names: Vec<&str> = gates.iter().map(String::as_str).collect();
    let mut source = Source::start();
    let recorder = source.record(&names, &["--format", "json"]);
    let first = source.sent("g0");
    for number in 0..COUNT {
        names.iter().for_each(|gate| source.send(gate, &number.to_le_bytes()));
        thread::sleep(Duration::from_millis(1));
    }
    let file = source.rover.path("flight.mcap");
    wait_until("the last message is recorded", || {
        let recorded = messages(&file);
        let last =
            |gate: &&&str| recorded.iter().rfind(|it| it.topic == format!("/source/{gate}")).map(|it| it.sequence);
        names.iter().filter(|gate| last(gate).map(u64::from) == Some(source.sent(gate) - 1)).count() == names.len()
    });
    let report = recorder.stop_json();
    let counts = counts(&file);
    for gate in names {
        let topic = format!("/source/{gate}");
        assert_eq!(figures(&report, &format!("source.{gate}")), (counts[&topic] as u64, 0));
        assert_eq!(sequences(&file, &topic, first), (first..first + COUNT).collect::<Vec<_>>());
    }
    assert_eq!(report["complete"], true);
    assert_eq!(summary(&file).stats.unwrap().message_count, counts.values().sum::<usize>() as u64);
}

#[test]
fn messages_have_the_times_and_numbers_of_the_tap() {
    let now = || SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_nanos() as u64;
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &[]);
    let before = now();
    let sent = source.send_numbers(100);
    let after = now();
    recorder.stop();
    let mut seen = messages(&source.rover.path("flight.mcap"));
    seen.retain(|message| u64::from(message.sequence) >= sent.start);
    assert_eq!(seen.iter().map(|message| message.sequence.into()).collect::<Vec<u64>>(), sent.collect::<Vec<_>>());
    for (number, message) in seen.into_iter().enumerate() {
        assert!(before <= message.publish_time && message.publish_time <= after);
        assert!(message.publish_time <= message.log_time);
        assert_eq!(message.data, (number as u64).to_le_bytes());
    }
}

#[test]
fn replies_have_the_numbers_of_their_requests() {
    let rover = Rover::start();
    let file = rover.path("flight.mcap");
    let recorder = Recorder::start(&rover, 6, &["--format", "json"]);
    wait_until("some replies are recorded", || counts(&file).get("/controller/commands/reply") > Some(&10));
    let report = recorder.stop_json();

    let mut requests = BTreeMap::new();
    let mut pairs = 0;
    for message in messages(&file) {
        match message.topic.as_str() {
            "/controller/commands/request" => drop(requests.insert(message.sequence, message)),
            "/controller/commands/reply" => match requests.remove(&message.sequence) {
                Some(request) => {
                    assert!(request.publish_time <= message.publish_time);
                    pairs += 1;
                }
                // Its request was sent before the recorder was connected.
                None => assert_eq!(pairs, 0),
            },
            _ => {}
        }
    }
    assert!(pairs > 10, "{pairs}");
    let (recorded, lost) = figures(&report, "controller.commands");
    assert_eq!(lost, 0);
    let counts = counts(&file);
    assert_eq!(recorded, (counts["/controller/commands/request"] + counts["/controller/commands/reply"]) as u64);
}

#[test]
fn a_file_says_everything_about_its_gates() {
    let rover = Rover::start();
    std::fs::write(rover.path("launch.yaml"), "components: {}\n").unwrap();
    let recorder = Recorder::start(&rover, 6, &["--format", "json"]);
    let file = rover.path("flight.mcap");
    wait_until("every gate has sent", || counts(&file).len() == 7);
    let report = recorder.stop_json();

    let summary = summary(&file);
    let channels = summary.channels.values().map(|channel| {
        let schema = channel.schema.as_ref().unwrap();
        assert_ne!(schema.id, 0);
        (channel.topic.clone(), (channel.message_encoding.clone(), schema.name.clone(), schema.encoding.clone()))
    });
    let channels: BTreeMap<_, _> = channels.collect();
    let of = |topic: &str| {
        let (message, name, schema) = &channels[topic];
        (message.as_str(), name.as_str(), schema.as_str())
    };
    assert_eq!(of("/sensor/measurements"), ("protobuf", "rover.Measurement", "protobuf"));
    assert_eq!(of("/sensor/position"), ("json", "rover.Position", "jsonschema"));
    assert_eq!(of("/sensor/image"), ("raw", "bytes", ""));
    assert_eq!(of("/controller/commands/request"), ("protobuf", "rover.Command", "protobuf"));
    assert_eq!(of("/controller/commands/reply"), ("protobuf", "rover.Status", "protobuf"));
    let measurements = summary.channels.values().find(|channel| channel.topic == "/sensor/measurements").unwrap();
    assert_eq!(measurements.metadata["kind"], "pub");
    assert_eq!(measurements.metadata["type"], "rover.Measurement");
    assert_eq!(measurements.metadata["peers"], "controller.sensor");
    assert_eq!(measurements.metadata["contract"].len(), 8);

    let bytes = std::fs::read(&file).unwrap();
    let attachment = |name: &str| {
        let index = summary.attachment_indexes.iter().rfind(|it| it.name == name);
        let found = mcap::read::attachment(&bytes, index.unwrap_or_else(|| panic!("no `{name}`"))).unwrap();
        String::from_utf8(found.data.into_owned()).unwrap()
    };
    let plan = SystemPlan::from_json(&attachment("plan.json")).unwrap();
    let names: Vec<_> = plan.components.iter().map(|component| component.component.as_str()).collect();
    assert_eq!(names, ["controller", "logger", "sensor", "user_interface"]);
    assert_eq!(attachment("topology.yaml"), std::fs::read_to_string(rover.path("topology.yaml")).unwrap());
    assert_eq!(attachment("launch.yaml"), "components: {}\n");

    // The first record begins with the profile, behind its length.
    assert_eq!(&bytes[17..24], b"\x03\0\0\0scl");
    assert!(summary.chunk_indexes.iter().all(|chunk| chunk.compression == "lz4"));
    let totals = mcap::read::metadata(&bytes, &summary.metadata_indexes[0]).unwrap().metadata;
    assert_eq!(totals["system"], "rover");
    for gate in report["gates"].as_array().unwrap() {
        let name = gate["gate"].as_str().unwrap();
        assert_eq!(totals[&format!("{name}.recorded")], gate["recorded"].to_string());
        assert_eq!(totals[&format!("{name}.lost")], gate["lost"].to_string());
    }
}

#[test]
fn gates_are_chosen_and_left_out_by_name() {
    let rover = Rover::start();
    let file = rover.path("flight.mcap");
    for (arguments, expected) in [
        // A gate that receives stands for the gates that send to it.
        (&["controller.sensor"][..], &["/sensor/measurements"][..]),
        (&["sensor", "--exclude", "sensor.image"], &["/sensor/measurements", "/sensor/position"]),
        (&["--exclude", "sensor", "--exclude", "controller.commands"], &["/controller/actuator", "/logger/events"]),
    ] {
        let recorder = Recorder::start(&rover, expected.len(), &[&["--overwrite"], arguments].concat());
        wait_until("all gates are in the file", || counts(&file).len() == expected.len());
        recorder.stop();
        assert_eq!(counts(&file).into_keys().collect::<Vec<_>>(), expected, "{arguments:?}");
    }
}

#[test]
fn what_a_recorder_that_hangs_misses_is_counted() {
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &["--format", "json"]);
    let file = source.rover.path("flight.mcap");
    let first = u64::from(messages(&file)[0].sequence);
    recorder.signal("-STOP");
    // More than the tap and the socket keep for it.
    let sent = source.send_numbers(20_000);
    recorder.signal("-CONT");
    wait_until("the newest message is recorded", || {
        messages(&file).last().is_some_and(|last| u64::from(last.sequence) == sent.end - 1)
    });
    let (recorded, lost) = figures(&recorder.stop_json(), "source.g0");
    assert!(lost > 0);
    assert_eq!(recorded + lost, source.sent("g0") - first);
    assert_eq!(recorded, messages(&file).len() as u64);
}

#[test]
fn the_report_is_a_table() {
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &[]);
    source.send_numbers(1234);
    let report = recorder.stop();
    let count = messages(&source.rover.path("flight.mcap")).len();
    let (table, last) = report.trim_end().rsplit_once('\n').unwrap();
    assert_eq!(table, format!("GATE       RECORDED  LOST\nsource.g0      {count}     0"));
    assert!(last.starts_with("flight.mcap: ") && last.ends_with(" s"), "{last}");
}

#[test]
fn recording_ends_after_a_time() {
    let rover = Rover::start();
    let files = ["--topology", "topology.yaml", "--launch", "other.yaml"];
    std::fs::write(rover.path("other.yaml"), "components: {}\n").unwrap();
    let arguments = [&["--for", "500ms", "--format", "json", "--overwrite"], &files[..]].concat();
    // Senders that get no processor are recorded again.
    let (code, out, err) = wait_for("a message is recorded", || {
        let (code, out, err) = Recorder::start(&rover, 6, &arguments).finish();
        (err != "no message was seen\n").then_some((code, out, err))
    });
    assert_eq!((code, err.as_str()), (Some(0), ""), "{out}");
    let attached = summary(&rover.path("flight.mcap")).attachment_indexes;
    assert!(attached.iter().any(|attachment| attachment.name == "launch.yaml"), "the file that was named");
}
