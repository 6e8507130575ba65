//! `scl replay` beside components that this test runs: what is sent, when, by whom, and what is refused.

mod peers;
mod rover;

use crate::system::{ChildGuard, SpawnGuarded, System, kill};
use rover::{Rover, text};
use scl::OpenOptions;
use scl::untyped::Component;
use scl_loader::{Request, load};
use scl_plan::SystemPlan;
use scl_record::testing::{Recorder, Sample};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const ROVER: &str = "\
system: rover
codec: json
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
      - log: {push: rover.Line}
  - name: controller
    gates:
      - newest: {sub: rover.Measurement, queue: 1}
      - history: {sub: rover.Measurement, queue: 10}
      - log: {pull: rover.Line, queue: 10}
      - commands: {rep: rover.Command -> rover.Status}
      - actuator: {pub: rover.Setpoint}
  - name: user_interface
    gates:
      - commands: {req: rover.Command -> rover.Status, timeout: 60s}
connections:
  - [sensor.measurements, controller.newest]
  - [sensor.measurements, controller.history]
  - [sensor.log, controller.log]
  - [user_interface.commands, controller.commands]
";

/// A test that waits longer has failed.
const HANG_LIMIT: Duration = Duration::from_secs(300);

const HOUR: u64 = 3_600_000;

#[test]
fn messages_are_sent_in_order_and_counted() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1"), (LOG, 5, "a"), (MEASUREMENTS, 5, "2"), (LOG, 5, "b")]);
    let mut controller = rover.open("controller");
    let mut history = controller.subscriber("history").unwrap();
    let mut log = controller.puller("log").unwrap();
    let replay = rover.start(&["flight.mcap", "--as", "sensor"]);
    assert_eq!([(); 2].map(|()| text(&history.recv_timeout(HANG_LIMIT).unwrap())), ["1", "2"]);
    assert_eq!([(); 2].map(|()| text(&log.recv_timeout(HANG_LIMIT).unwrap())), ["a", "b"]);
    let output = replay.wait_with_output();
    assert_eq!(text(&output.stderr), "");
    let report = text(&output.stdout);
    let (first, rest) = report.split_once('\n').unwrap();
    assert!(first.starts_with("replayed 4 messages in "), "{report}");
    assert_eq!(rest, "  sensor.measurements          2\n  controller.log               2 sent by sensor.log\n");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn a_latched_gate_stays_latched() {
    let mut rover = Rover::new();
    let latched = "{pub: rover.Measurement, latched: true}";
    rover.plan = rover.plan_of(&ROVER.replace("{pub: rover.Measurement}", latched));
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1"), (MEASUREMENTS, 5, "2"), (LOG, HOUR, "end")]);
    let replay = rover.start(&["flight.mcap", "--as", "sensor", "--ready", "0s"]);
    for is_late in [false, true, true] {
        let mut controller = rover.open("controller");
        for gate in ["newest", "history"] {
            let mut gate = controller.subscriber(gate).unwrap();
            let mut received = text(&gate.recv_timeout(HANG_LIMIT).unwrap());
            while received != "2" && !is_late {
                received = text(&gate.recv_timeout(HANG_LIMIT).unwrap());
            }
            assert_eq!(received, "2");
            assert!(gate.latched_age().is_some() || !is_late);
        }
    }
    kill("-INT", replay.id());
    replay.wait_with_output();
}

#[test]
fn the_rate_scales_time() {
    let rover = Rover::new();
    let _controller = rover.open("controller");
    rover.record("short.mcap", &[(MEASUREMENTS, 0, "1"), (MEASUREMENTS, 150, "2"), (MEASUREMENTS, 300, "3")]);
    let seconds = |arguments: &[&str]| rover.replay_json(arguments)["seconds"].as_f64().unwrap();
    assert!(seconds(&["short.mcap", "--as", "sensor"]) >= 0.3);
    assert!(seconds(&["short.mcap", "--as", "sensor", "--rate", "0.5"]) >= 0.6);
    // At the recorded pace, these would take hours.
    rover.record("long.mcap", &[(MEASUREMENTS, 0, "1"), (MEASUREMENTS, HOUR, "2"), (MEASUREMENTS, 3 * HOUR, "3")]);
    let report = rover.replay_json(&["long.mcap", "--as", "sensor", "--rate", "1e5"]);
    assert_eq!(report["sent"], 3);
    assert!(report["seconds"].as_f64().unwrap() >= 0.108, "{report}");
    assert!(report["late_us"]["max"].is_number(), "{report}");
    assert_eq!(
        rover.replay_json(&["long.mcap", "--as", "sensor", "--rate", "max", "--system", "beside", "--ready", "0s"])["sent"],
        3
    );
    let report = rover.replay_json(&["long.mcap", "--as", "sensor", "--start", "1h", "--end", "2h"]);
    assert_eq!(report["sent"], 1);
}

#[test]
fn a_part_of_a_recording_is_replayed() {
    let rover = Rover::new();
    let samples: Vec<Sample<'_>> =
        ["0", "1", "2", "3", "4"].iter().zip(0..).map(|(text, at)| (MEASUREMENTS, 10 * at, *text)).collect();
    rover.record("flight.mcap", &samples);
    let mut controller = rover.open("controller");
    let mut history = controller.subscriber("history").unwrap();
    let replay = rover.start(&["flight.mcap", "--as", "sensor", "--start", "10ms", "--end", "30ms"]);
    assert_eq!([(); 2].map(|()| text(&history.recv_timeout(HANG_LIMIT).unwrap())), ["1", "2"]);
    assert!(replay.wait_with_output().status.success());
    for (arguments, error) in [
        (["--start", "10min"], "error: `--start 600s` is after the end of the recording, which is 40.0ms long\n"),
        (["--end", "0s"], "error: nothing is left to replay: `--end` is not after `--start`\n"),
    ] {
        assert_eq!(rover.fails(&[&["flight.mcap"], &arguments[..]].concat()), error);
    }
}

#[test]
fn a_loop_goes_on_until_it_is_stopped() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1"), (MEASUREMENTS, 10, "2")]);
    let mut controller = rover.open("controller");
    let mut history = controller.subscriber("history").unwrap();
    let replay = rover.start(&["flight.mcap", "--as", "sensor", "--loop"]);
    let seen = [(); 5].map(|()| text(&history.recv_timeout(HANG_LIMIT).unwrap()));
    assert_eq!(seen, ["1", "2", "1", "2", "1"]);
    // The program whose component is played is told so.
    let options = OpenOptions::new().runtime_dir(rover.system.path("run"));
    let refused = Component::open_blocking_with(rover.plan.component("sensor").unwrap(), options).err().unwrap();
    let refused = format!("{:?}", scl::Error::from(refused));
    assert!(refused.contains(&format!("already running as process {}", replay.id())), "{refused}");
    kill("-INT", replay.id());
    let output = replay.wait_with_output();
    assert!(text(&output.stdout).starts_with("stopped: replayed "), "{output:?}");
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
}

#[test]
fn without_a_limit_of_speed_nothing_is_lost_however_slow_the_subscriber_is() {
    const COUNT: u64 = 20_000;
    let rover = Rover::new();
    let numbers: Vec<String> = (0..COUNT).map(|number| number.to_string()).collect();
    let messages = numbers.iter().flat_map(|number| [(MEASUREMENTS, 0, number.as_str()), (LOG, 0, number)]);
    rover.record("flight.mcap", &messages.collect::<Vec<_>>());
    let mut controller = rover.open("controller");
    let mut replay = Some(rover.start(&["flight.mcap", "--as", "sensor", "--rate", "max"]));
    let mut newest = controller.subscriber("newest").unwrap();
    let mut history = controller.subscriber("history").unwrap();
    let mut log = controller.puller("log").unwrap();
    std::thread::scope(|scope| {
        // One does not wait, one passes over what is old, and one is slow now and then.
        scope.spawn(|| {
            numbers.iter().for_each(|number| {
                assert_eq!(text(&newest.recv_timeout(HANG_LIMIT).unwrap()), *number);
            })
        });
        scope.spawn(|| {
            numbers.iter().for_each(|number| {
                assert_eq!(text(&log.recv_timeout(HANG_LIMIT).unwrap()), *number);
            })
        });
        for (index, number) in numbers.iter().enumerate() {
            if index % 500 == 0 {
                std::thread::sleep(Duration::from_millis(10));
            }
            assert_eq!(text(&history.recv_timeout(HANG_LIMIT).unwrap()), *number);
        }
    });
    let output = replay.take().unwrap().wait_with_output();
    assert!(text(&output.stdout).starts_with("replayed 40000 messages in "), "{output:?}");
    assert!(output.status.success());
}

#[test]
fn played_components_take_what_others_of_them_send() {
    let rover = Rover::new();
    rover.record("flight.mcap", &vec![(MEASUREMENTS, 0, "1"); 5000]);
    let report = rover.replay_json(&["flight.mcap", "--rate", "max"]);
    assert_eq!((&report["sent"], &report["not_taken"]), (&5000.into(), &serde_json::json!([])), "{report}");
}

#[test]
fn requests_are_repeated_and_answered() {
    let rover = Rover::new();
    let (request, reply) = ("/controller/commands/request", "/controller/commands/reply");
    let recorder = rover.recorder().messages(&[(request, 0, "faster"), (request, 1, "slower")]).restart_numbers();
    recorder.messages(&[(reply, 2, "yes"), (reply, 3, "no")]).write_to(&rover.system.path(""), "flight.mcap");

    let mut controller = rover.open("controller");
    let mut commands = controller.replier("commands").unwrap();
    let replay = rover.start(&["flight.mcap", "--as", "user_interface", "--format", "json"]);
    for expected in ["faster", "slower"] {
        let command = commands.recv_timeout(HANG_LIMIT).unwrap();
        assert_eq!(text(command.message()), expected);
        command.reply(&"live".into()).unwrap();
    }
    let report: serde_json::Value = serde_json::from_slice(&replay.wait_with_output().stdout).unwrap();
    assert_eq!((&report["gates"][0]["sent"], &report["gates"][0]["replies"]), (&2.into(), &2.into()), "{report}");
    drop((commands, controller));

    // The other way round: the recorded controller answers.
    let mut user_interface = rover.open("user_interface");
    let mut commands = user_interface.requester("commands").unwrap();
    let replay = rover.start(&["flight.mcap", "--as", "controller", "--loop", "--ready", "0s", "--format", "json"]);
    let answers = ["slower", "faster", "faster"]
        .map(|command| text(&commands.call_timeout(&command.to_owned().into(), HANG_LIMIT).unwrap()));
    assert_eq!(answers, ["no", "yes", "yes"]);
    kill("-INT", replay.id());
    let report: serde_json::Value = serde_json::from_slice(&replay.wait_with_output().stdout).unwrap();
    assert_eq!(
        report["answers"][0],
        serde_json::json!({"gate": "controller.commands", "answered": 3, "in_order": 0, "unanswered": 0})
    );
    assert_eq!(report["gates"][0]["reason"], format!("`user_interface` is running as process {}", std::process::id()));
}

#[test]
fn what_runs_is_not_played() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1"), (ACTUATOR, 1, "0.5")]);
    let _controller = rover.open("controller");
    let report = rover.replay_json(&["flight.mcap"]);
    assert_eq!((&report["gates"][0]["sent"], &report["gates"][1]["skipped"]), (&1.into(), &1.into()), "{report}");
    let pid = std::process::id();
    assert_eq!(report["gates"][1]["reason"], format!("`controller` is running as process {pid}"));
    let error = rover.fails(&["flight.mcap", "--as", "sensor,controller"]);
    assert_eq!(
        error,
        format!(
            "error: component `controller` is already running as process {pid}\n  \
             = help: stop it first, or replay into another system with `--system`\n"
        )
    );
    let report =
        rover.replay_json(&["flight.mcap", "--as", "sensor,controller", "--system", "beside", "--ready", "0s"]);
    assert_eq!(report["sent"], 2, "{report}");
    let report = rover.replay_json(&["flight.mcap", "--as", "sensor", "--only", "controller.actuator"]);
    assert_eq!((&report["sent"], &report["gates"][0]["reason"]), (&0.into(), &"not selected by `--only`".into()));
}

#[test]
fn a_running_program_with_another_contract_is_refused() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1")]);
    let other = rover.plan_of(&ROVER.replace("rover.Measurement", "rover.Reading"));
    let _controller = rover.open_planned(&other, "controller");
    let error = rover.fails(&["flight.mcap", "--as", "sensor"]);
    assert!(
        error.starts_with(
            "error: `sensor.measurements` was recorded as `rover.Measurement` (json), but the running `controller.newest` \
             was built for `rover.Reading` (json)\n  = help: run the program that was recorded, or make a new recording\n"
        ),
        "{error}"
    );
}

#[test]
fn another_topology_is_compared_with_the_recording() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1")]);
    rover.system.write("typed.yaml", &ROVER.replace("rover.Measurement", "rover.Reading"));
    assert_eq!(
        rover.fails(&["flight.mcap", "--as", "sensor", "--topology", "typed.yaml"]),
        "error: `sensor.measurements` was recorded as `rover.Measurement` (json), but the topology declares \
         `rover.Reading` (json)\n  = help: use the topology of the recording: leave out `--topology`\n"
    );
    rover.system.write("renamed.yaml", &ROVER.replace("measurements", "measurement"));
    assert_eq!(
        rover.fails(&["flight.mcap", "--as", "sensor", "--topology", "renamed.yaml"]),
        "error: `sensor.measurements` was recorded, but the topology has no such gate\n  \
         = help: was it renamed to `sensor.measurement`?\n"
    );
    rover.system.write("broken.yaml", "system: [");
    assert!(rover.fails(&["flight.mcap", "--topology", "broken.yaml"]).contains("broken.yaml:1:"));
    // A recording without a plan needs one.
    let recorder = Recorder::new().of_plan(&rover.plan).messages(&[(MEASUREMENTS, 0, "1")]);
    recorder.write_to(&rover.system.path(""), "bare.mcap");
    assert!(rover.fails(&["bare.mcap"]).contains("= help: name the topology file with `--topology`"));
    rover.system.write("topology.yaml", ROVER);
    let report = rover.replay_json(&["bare.mcap", "--topology", "topology.yaml", "--as", "sensor", "--ready", "0s"]);
    assert_eq!(report["sent"], 1);
}

#[test]
fn missing_peers_are_named() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1")]);
    let error = rover.fails(&["flight.mcap", "--as", "sensor", "--ready", "100ms"]);
    assert!(error.contains("component `sensor` is not ready after "), "{error}");
    assert!(error.contains("`controller.newest` is not running") && error.contains("`--ready 0s`"), "{error}");
}

#[test]
fn mistakes_are_explained() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1")]);
    rover.system.write("empty.mcap", "");
    rover.system.write("notes.txt", "speed");
    rover.recorder().other_message(("/tf", "cdr", "ros2msg"), b"").write_to(&rover.system.path(""), "ros.mcap");
    rover.record("silent.mcap", &[]);
    for (arguments, expected) in [
        (
            &["flight.mcap", "--as", "sensr"][..],
            "error: system `rover` has no component `sensr`; did you mean `sensor`?\n",
        ),
        (&["flight.mcap", "--only", "sensor.measurement"], "  = help: did you mean `sensor.measurements`?\n"),
        (&["nothing.mcap"], "error: there is no file `nothing.mcap`\n"),
        (&["empty.mcap"], "error: the recording `empty.mcap` is empty\n"),
        (&["notes.txt"], "error: `notes.txt` is not a recording\n"),
        (&["ros.mcap"], "  = note: `/tf` was not recorded by SCL: it is not `/<comp"),
        (&["silent.mcap"], "error: the recording `silent.mcap` has no messages\n"),
        (&["flight.mcap", "--rate", "fast"], "expected a factor above 0, like `0.5` or `2`, or `max`"),
        (&["flight.mcap", "--rate", "0"], "expected a factor above 0"),
    ] {
        let error = rover.fails(arguments);
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
}

#[test]
fn a_recording_that_was_cut_off_is_replayed_as_far_as_it_goes() {
    let rover = Rover::new();
    let recorder = rover.recorder().messages(&[(MEASUREMENTS, 0, "1")]).end_chunk();
    let whole = recorder.messages(&[(MEASUREMENTS, 1, "2")]).end_chunk().finish();
    let _controller = rover.open("controller");
    let mut sent_before = 0;
    for length in (whole.len() / 3..whole.len()).step_by(whole.len() / 12) {
        std::fs::write(rover.system.path("cut.mcap"), &whole[..length]).unwrap();
        let output = rover.start(&["cut.mcap", "--as", "sensor", "--format", "json"]).wait_with_output();
        let sent = serde_json::from_slice::<serde_json::Value>(&output.stdout)
            .map_or(0, |report| report["sent"].as_u64().unwrap());
        let said = text(&output.stderr);
        assert!(
            sent >= sent_before
                && (sent == 2
                    || said.starts_with("note: `cut.mcap` ")
                    || said.contains("no messages")
                    || said.contains("no plan")),
            "{said}"
        );
        sent_before = sent;
    }
    assert_eq!(sent_before, 2);
}

#[cfg(feature = "run")]
#[test]
fn a_launch_file_replays_a_component() {
    let rover = Rover::new();
    rover.record("flight.mcap", &[(MEASUREMENTS, 0, "1"), (ACTUATOR, 5, "0.5"), (MEASUREMENTS, 10, "2")]);
    rover.system.write("topology.yaml", ROVER);
    let launch = "components:\n  sensor: {replay: flight.mcap, ready_within: 60s}\n  controller: {command: [cat]}\n  \
                  user_interface: {command: [cat]}\n";
    rover.system.write("launch.yaml", launch);
    let mut controller = rover.open("controller");
    let mut history = controller.subscriber("history").unwrap();
    let mut run = rover.system.scl(&["run", "--only", "sensor"]);
    run.env("SCL_RUNTIME_DIR", rover.system.path("run")).stdout(Stdio::piped()).stderr(Stdio::piped());
    let run = run.spawn_guarded();
    assert_eq!([(); 2].map(|()| text(&history.recv_timeout(HANG_LIMIT).unwrap())), ["1", "2"]);
    let output = run.wait_with_output();
    assert!(text(&output.stdout).contains("replayed 2 messages in "), "{output:?}");
    assert!(text(&output.stderr).contains("all components are ready"), "{output:?}");
    assert!(output.status.success(), "{output:?}");
}

const MEASUREMENTS: &str = "/sensor/measurements";
const LOG: &str = "/controller/log";
const ACTUATOR: &str = "/controller/actuator";
