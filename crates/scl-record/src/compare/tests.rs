use super::*;
use crate::testing::Recorder;
use std::path::Path;

const TOPIC: &str = "/controller/actuator";

fn recording(folder: &Path, name: &str, numbers: impl IntoIterator<Item = f64>) -> Recording {
    let payloads: Vec<_> = numbers.into_iter().map(|number| format!(r#"{{"throttle": {number}}}"#)).collect();
    let samples: Vec<_> = payloads.iter().zip(0..).map(|(payload, at)| (TOPIC, 10 * at, payload.as_str())).collect();
    Recording::open(&[Recorder::new().messages(&samples).write_to(folder, name)]).unwrap()
}

fn compared(first: &[f64], second: &[f64], options: &CompareOptions) -> String {
    let folder = tempfile::tempdir().unwrap();
    let first = recording(folder.path(), "first.mcap", first.iter().copied());
    let second = recording(folder.path(), "second.mcap", second.iter().copied());
    match compare(&first, &second, options, &|_| {}) {
        Ok(report) => report.to_text(),
        Err(problem) => problem.to_string().replace(&folder.path().display().to_string(), ""),
    }
}

fn check(first: &[f64], second: &[f64], expected: &str) {
    let options = CompareOptions { shown: 3, within: 0.01, ..CompareOptions::default() };
    assert_eq!(compared(first, second, &options), expected, "{first:?} {second:?}");
}

#[test]
fn what_differs_is_named() {
    let all: Vec<f64> = (0..100).map(f64::from).collect();
    let changed =
        |at: usize, to: f64| all.iter().enumerate().map(|(i, n)| if i == at { to } else { *n }).collect::<Vec<_>>();
    check(&all, &all, "controller.actuator: 100 messages equal\n");
    check(&all, &changed(7, 7.01), "controller.actuator: 100 messages equal\n");
    check(
        &all,
        &changed(7, 7.02),
        "controller.actuator: 1 of 100 messages different, 0 missing, 0 additional\n  \
         message 7 at 0.070 s, throttle: 7 -> 7.02\n",
    );
}

#[test]
fn a_missing_or_additional_message_is_one_difference() {
    let all: Vec<f64> = (0..100).map(f64::from).collect();
    let without = |gone: &[usize]| -> Vec<f64> {
        all.iter().enumerate().filter(|(index, _)| !gone.contains(index)).map(|(_, number)| *number).collect()
    };
    let missing = "controller.actuator: 0 of 99 messages different, 1 missing, 0 additional\n  message";
    check(&all, &without(&[0]), &format!("{missing} 0 at 0.000 s is missing: {{\"throttle\":0}}\n"));
    check(&all, &without(&[50]), &format!("{missing} 50 at 0.500 s is missing: {{\"throttle\":50}}\n"));
    check(&all, &without(&[99]), &format!("{missing} 99 at 0.990 s is missing: {{\"throttle\":99}}\n"));
    check(
        &without(&[50, 51, 52, 53]),
        &all,
        "controller.actuator: 0 of 96 messages different, 0 missing, 4 additional\n  \
         4 messages, 50 at 0.500 s to 53 at 0.530 s, are additional\n",
    );
    check(
        &all[..2],
        &[],
        "controller.actuator: 0 of 0 messages different, 2 missing, 0 additional\n  \
         2 messages, 0 at 0.000 s to 1 at 0.010 s, are missing\n",
    );
}

#[test]
fn a_gap_of_any_length_is_one_difference() {
    let all: Vec<f64> = (0..5000).map(f64::from).collect();
    let without = |gone: std::ops::Range<usize>| [&all[..gone.start], &all[gone.end..]].concat();
    for (gone, time) in [
        (100..117, "1.000 s to 116 at 1.160 s"),
        (1000..4000, "10.000 s to 3999 at 39.990 s"),
        (0..600, "0.000 s to 599 at 5.990 s"),
    ] {
        let (start, count) = (gone.start, gone.len());
        let expected = |kind: &str| {
            let (missing, additional) = if kind == "missing" { (count, 0) } else { (0, count) };
            format!(
                "controller.actuator: 0 of {} messages different, {missing} missing, {additional} additional\n  \
                 {count} messages, {start} at {time}, are {kind}\n",
                5000 - count
            )
        };
        check(&all, &without(gone.clone()), &expected("missing"));
        check(&without(gone), &all, &expected("additional"));
    }
}

#[test]
fn gaps_on_both_sides_and_changes_are_told_apart() {
    let all: Vec<f64> = (0..1000).map(f64::from).collect();
    let mut first = all.clone();
    first.drain(600..700);
    let mut second = all;
    second[900] += 0.5;
    second.drain(200..250);
    check(
        &first,
        &second,
        "controller.actuator: 1 of 850 messages different, 50 missing, 100 additional\n  \
         50 messages, 200 at 2.000 s to 249 at 2.490 s, are missing\n  \
         100 messages, 550 at 5.500 s to 649 at 6.490 s, are additional\n  \
         message 800 at 8.000 s, throttle: 900 -> 900.5\n",
    );
}

/// The numbers of messages decide where content alone would find the gap too early.
#[test]
fn a_gap_in_a_signal_that_repeats_itself_has_its_length() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name, gone: std::ops::Range<u64>| {
        let payloads: Vec<_> = (0..400).map(|number| format!(r#"{{"throttle": {}}}"#, number % 20)).collect();
        let samples: Vec<_> =
            payloads.iter().zip(0..).map(|(payload, at)| (TOPIC, 10 * at, payload.as_str())).collect();
        let mut recorder = Recorder::new();
        for (index, sample) in samples.into_iter().enumerate() {
            recorder =
                if gone.contains(&(index as u64)) { recorder.lose_message() } else { recorder.messages(&[sample]) };
        }
        Recording::open(&[recorder.write_to(folder.path(), name)]).unwrap()
    };
    let (first, second) = (write("first.mcap", 0..0), write("second.mcap", 101..146));
    let report = compare(&first, &second, &CompareOptions { shown: 3, ..CompareOptions::default() }, &|_| {}).unwrap();
    assert_eq!(
        report.to_text(),
        "controller.actuator: 0 of 355 messages different, 45 missing, 0 additional\n  \
         45 messages, 101 at 1.010 s to 145 at 1.450 s, are missing\n"
    );
}

/// Recordings that have nothing in common are paired message by message, in a time that grows with their length.
#[test]
fn recordings_of_another_signal_are_paired_as_they_are() {
    let first: Vec<f64> = (0..40_000).map(f64::from).collect();
    let second: Vec<f64> = first.iter().map(|number| number + 0.5).collect();
    let text = compared(&first, &second, &CompareOptions::default());
    assert_eq!(
        text,
        "controller.actuator: 40000 of 40000 messages different, 0 missing, 0 additional\n  and 40000 more\n"
    );
}

#[test]
fn different_lengths_and_changes_add_up() {
    // Whatever is found, every message of both recordings is counted once.
    let mut seed = 1_u64;
    let mut random = |below: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % below
    };
    for _ in 0..50 {
        let mut make = || (0..random(60)).map(|_| random(3) as f64).collect::<Vec<_>>();
        let (first, second) = (make(), make());
        let folder = tempfile::tempdir().unwrap();
        let lengths = [first.len() as u64, second.len() as u64];
        let first = recording(folder.path(), "first.mcap", first);
        let second = recording(folder.path(), "second.mcap", second);
        let Ok(report) = compare(&first, &second, &CompareOptions::default(), &|_| {}) else {
            assert_eq!(lengths, [0, 0]);
            continue;
        };
        let gate = &report.gates[0];
        assert_eq!([gate.paired + gate.missing, gate.paired + gate.additional], lengths);
    }
}

#[test]
fn fields_and_times_are_compared_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name, samples: &[(&str, u64, &str)]| {
        Recording::open(&[Recorder::new().messages(samples).write_to(folder.path(), name)]).unwrap()
    };
    let first =
        write("first.mcap", &[(TOPIC, 0, r#"{"a": 1, "b": {"c": 2}}"#), (TOPIC, 10, r#"{"a": 1, "b": {"c": 2}}"#)]);
    let second =
        write("second.mcap", &[(TOPIC, 5, r#"{"a": 9, "b": {"c": 2}}"#), (TOPIC, 16, r#"{"a": 1, "b": {"c": 3}}"#)]);
    let compared = |fields: &[&str], times_within| {
        let fields = fields.iter().map(|field| field.parse().unwrap()).collect();
        let options = CompareOptions { fields, times_within, shown: 9, ..CompareOptions::default() };
        match compare(&first, &second, &options, &|_| {}) {
            Ok(report) => report.gates[0].differences.iter().map(|it| it.field.clone()).collect::<Vec<_>>().join(" "),
            Err(problem) => problem.to_string(),
        }
    };
    assert_eq!(compared(&[], None), "a b.c");
    assert_eq!(compared(&["b.c"], None), "b.c");
    assert_eq!(compared(&["a", "b"], None), "a b.c");
    assert_eq!(compared(&["a"], Some(Duration::from_millis(1))), "a");
    assert_eq!(compared(&["a"], Some(Duration::from_micros(999))), "a @time");
    assert!(compared(&["a", "x.y"], None).starts_with("error: no compared message has a field `x.y`\n"));
}

#[test]
fn other_types_and_unknown_gates_cannot_be_compared() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name, codec, type_name| {
        let recorder = Recorder::new().message_of_type((TOPIC, 0, "{}"), codec, type_name);
        Recording::open(&[recorder.write_to(folder.path(), name)]).unwrap()
    };
    let first = write("first.mcap", "json", "rover.Setpoint");
    let fails = |second: &Recording, gate: &str| {
        let options = CompareOptions { gates: vec![gate.to_owned()], ..CompareOptions::default() };
        let problem = compare(&first, second, &options, &|_| {}).unwrap_err().to_string();
        problem.replace(&format!("{}/", folder.path().display()), "")
    };
    assert_eq!(
        fails(&write("second.mcap", "cbor", "rover.Throttle"), "controller.actuator"),
        "error: `controller.actuator` cannot be compared: it is `rover.Setpoint` (json) in `first.mcap`, but \
         `rover.Throttle` (cbor) in `second.mcap`\n  = help: compare other gates with `--gate`\n"
    );
    assert_eq!(
        fails(&first, "controller.actuators"),
        "error: neither recording has messages of a gate `controller.actuators`\n  \
         = help: did you mean `controller.actuator`?\n"
    );
    let empty = recording(folder.path(), "empty.mcap", []);
    let problem = compare(&empty, &empty, &CompareOptions::default(), &|_| {}).unwrap_err().to_string();
    assert!(problem.starts_with("error: there is nothing to compare: "), "{problem}");
}

#[test]
fn what_cannot_be_decoded_is_compared_byte_by_byte() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name, codec, payload| {
        let recorder = Recorder::new().message_of_type((TOPIC, 0, payload), codec, "rover.Setpoint");
        Recording::open(&[recorder.write_to(folder.path(), name)]).unwrap()
    };
    let options = CompareOptions { shown: 1, ..CompareOptions::default() };
    for codec in ["postcard", "json"] {
        let (first, second) = (write("first.mcap", codec, "{a"), write("second.mcap", codec, "{b"));
        let text = compare(&first, &second, &options, &|_| {}).unwrap().to_text();
        assert!(text.ends_with("  message 0 at 0.000 s: 2 bytes: 7b61 -> 2 bytes: 7b62\n"), "{text}");
        assert!(compare(&first, &first, &options, &|_| {}).unwrap().is_equal());
    }
}
