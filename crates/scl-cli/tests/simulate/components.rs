//! Components of SCL in simulated time: async, blocking, and with several threads.

use super::{errors, lines_of, of_components, plan, simulate, text};
use crate::system::{ChildGuard, SpawnGuarded, System, kill};
use scl::bytes::Bytes;
use scl::runtime_dir::{ComponentStats, RuntimeDir};
use scl::untyped::Component;
use scl_tests::wait_until;
use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Output, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::{Duration, Instant};

const TOPOLOGY: &str = "\
system: mill
components:
  - name: sensor
    gates:
      - values: pub
      - settings: rep
  - name: controller
    gates:
      - values: {sub: , queue: 1}
      - commands: pub
      - settings: {req: , timeout: 1s}
  - name: logger
    gates:
      - commands: sub
connections:
  - [sensor.values, controller.values]
  - [controller.settings, sensor.settings]
  - [controller.commands, logger.commands]
";

/// Names the program that a process is.
const PLAYS: &str = "SCL_TEST_SIMULATE_PLAYS";
/// The file on which the sensor depends, if it exists: then it sends what it contains, and changes it.
const OUTSIDE: &str = "outside";
const ROUGH: &str = "\
delays: {sensor.*: 1ms..9ms, controller.settings: 5ms}
takes: {logger: 0ms..20ms}
faults:
  - {every: 100ms..900ms, cut: any, for: 10ms..600ms}
  - {every: 300ms..900ms, kill: any}
";
const MS: Duration = Duration::from_millis(1);

/// Starts the programs of the system in this order.
fn system(test: &str, order: &[&str]) -> System {
    of_components(TOPOLOGY, test, PLAYS, order)
}

/// Plays the component that the environment names, or returns.
fn play() -> bool {
    match std::env::var(PLAYS).as_deref() {
        Ok("sensor") => in_async(sense()),
        Ok("controller") => control(),
        Ok(_) => in_async(log()),
        Err(_) => return false,
    }
    true
}

fn in_async(component: impl Future<Output = ()>) {
    tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap().block_on(component);
}

/// Sends a value every 10 ms, answers meanwhile, and fails after 2 s.
async fn sense() {
    let mut sensor = Component::open(&plan("sensor")).await.unwrap();
    let (mut values, mut settings) = (sensor.publisher("values").unwrap(), sensor.replier("settings").unwrap());
    let mut tick = tokio::time::interval(10 * MS);
    let mut answered = 0;
    let started = Instant::now();
    while started.elapsed() < 2000 * MS {
        tokio::select! {
            _ = tick.tick() => {
                let outside = change_outside();
                values.send(&format!("{answered} {:?}{outside}", started.elapsed()).into()).await.unwrap();
            }
            request = settings.recv() => {
                answered += 1;
                request.unwrap().reply(&Bytes::from(answered.to_string())).unwrap();
            }
        }
    }
    std::process::exit(3);
}

fn change_outside() -> String {
    let Ok(outside) = fs::read_to_string(OUTSIDE) else { return String::new() };
    fs::write(OUTSIDE, format!("{outside}+")).unwrap();
    outside
}

/// Sends a command for each value, while another thread calls.
fn control() {
    let mut controller = Component::open_blocking(&plan("controller")).unwrap();
    let (mut values, mut commands) =
        (controller.subscriber("values").unwrap(), controller.publisher("commands").unwrap());
    let mut settings = controller.requester("settings").unwrap();
    let (sender, answers) = channel();
    thread::spawn(move || {
        loop {
            thread::sleep(70 * MS);
            let answer = settings.call_blocking(&Bytes::new());
            // The text of an error names processes by their numbers.
            sender.send(answer.map_or_else(|_| "none".to_owned(), |bytes| text(&bytes))).unwrap();
        }
    });
    while let Ok(value) = values.recv_blocking() {
        let answers: Vec<String> = answers.try_iter().collect();
        let command = format!("{} {answers:?}", text(&value));
        if commands.send_blocking(&command.into()).is_err() {
            return;
        }
    }
}

/// Prints commands, in the order of a hash map, while blocking work is in progress.
async fn log() {
    let mut logger = Component::open(&plan("logger")).await.unwrap();
    let mut commands = logger.subscriber("commands").unwrap();
    let mut kept = HashMap::new();
    while let Ok(command) = commands.recv().await {
        let work: Vec<_> = (0..3).map(|number| tokio::task::spawn_blocking(move || number * 2)).collect();
        let mut sum = 0;
        for work in work {
            sum += work.await.unwrap();
        }
        kept.insert(text(&command), sum);
        if kept.len() == 50 {
            kept.drain().for_each(|(command, sum)| println!("{command} {sum}"));
        }
    }
}

#[test]
fn everything_is_the_same_in_each_run_whatever_the_machine_does() {
    if play() {
        return;
    }
    let test = "simulate::components::everything_is_the_same_in_each_run_whatever_the_machine_does";
    let run = |busy: bool, order: [&str; 3]| -> (Output, Vec<u8>) {
        let system = system(test, &order);
        let load: Vec<ChildGuard> = (0..if busy { 8 } else { 0 }).map(|_| spin()).collect();
        let output = simulate(&system, &["--until", "20s", "-o", "mill.mcap"]);
        drop(load);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let mut recording = Vec::new();
        fs::File::open(system.path("mill.mcap")).unwrap().read_to_end(&mut recording).unwrap();
        (output, recording)
    };
    let ((idle, first), (busy, second)) =
        (run(false, ["sensor", "controller", "logger"]), run(true, ["sensor", "controller", "logger"]));
    // The launch file with its folder is a part of the recording.
    assert!(first == second, "the recordings differ");
    // Also in the order in which different programs print. The recorder prints where its file is.
    let by_components = |output: &Output| -> Vec<String> {
        text(&output.stdout).lines().filter(|line| !line.starts_with("recorder")).map(str::to_owned).collect()
    };
    assert!(by_components(&idle) == by_components(&busy), "they print something else, or in another order");
    let printed = text(&idle.stdout);
    let logged = lines_of(&printed, "logger");
    // The sensor sends for 2 s, 200 values, and is started again after 100 ms, 200 ms, and so on.
    assert!(logged.len() > 1000, "{}", logged.len());
    assert!(logged.iter().any(|line| line.contains("[\"14\"]")), "{logged:?}");
    let told = |output: &Output| lines_of(&errors(output), "sensor").join("\n");
    assert_eq!(told(&idle), told(&busy));
    // The order in which they are started is of no importance, either; only the launch file in the recording is
    // another.
    let (reversed, third) = run(false, ["logger", "controller", "sensor"]);
    assert!(by_components(&idle) == by_components(&reversed), "they print something else, or in another order");
    let recordings = System::of_files(&[]);
    fs::write(recordings.path("first.mcap"), first).unwrap();
    fs::write(recordings.path("third.mcap"), third).unwrap();
    let compared = recordings.scl(&["compare", "first.mcap", "third.mcap", "--times-within", "0ms"]).output().unwrap();
    assert!(compared.status.success(), "{}", text(&compared.stdout));
    assert!(
        told(&idle).contains("ended with exit code 3 after 2.0 s\nsensor      restarting in 200ms"),
        "{}",
        told(&idle)
    );
}

/// A process that keeps a processor busy.
fn spin() -> ChildGuard {
    Command::new("sh").args(["-c", "while :; do :; done"]).spawn_guarded()
}

/// The time of a simulation that is slower than the machine is soon far behind that of the tools that look at it.
#[test]
fn tools_see_that_programs_work_although_their_time_is_behind() {
    if play() {
        return;
    }
    let test = "simulate::components::tools_see_that_programs_work_although_their_time_is_behind";
    let system = system(test, &["logger", "controller", "sensor"]);
    let mut simulation = system.scl(&["simulate", "--speed", "0.5"]);
    let mut simulation = simulation.stdout(Stdio::null()).stderr(Stdio::piped()).spawn_guarded();
    let mut lines = BufReader::new(simulation.stderr.take().unwrap()).lines().map(Result::unwrap);
    let folder =
        lines.find_map(|line| Some(line.split_once("SCL_RUNTIME_DIR=")?.1.split_once(' ')?.0.to_owned())).unwrap();
    thread::spawn(move || lines.count());

    let runtime = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.clone().into())).unwrap();
    let behind = || {
        let figures = ComponentStats::read(&runtime.existing_system("mill").ok()??, "logger")?;
        figures.written.elapsed().ok()
    };
    wait_until("the time of the programs is behind", || behind().is_some_and(|by| by > Duration::from_secs(4)));
    let listed = system.scl(&["list", "--format", "json"]).env("SCL_RUNTIME_DIR", &folder).output().unwrap();
    let listed: Value = serde_json::from_slice(&listed.stdout).unwrap();
    let logger = listed["components"].as_array().unwrap().iter().find(|it| it["name"] == "logger");
    let logger = logger.unwrap_or_else(|| panic!("{listed}"));
    assert!(logger["silent_for_s"].is_null(), "{logger}");
    // It removes its folder.
    kill("-TERM", simulation.id());
    assert!(simulation.wait().is_ok());
}

#[test]
fn twice_names_what_depends_on_something_else() {
    if play() {
        return;
    }
    let test = "simulate::components::twice_names_what_depends_on_something_else";
    let system = system(test, &["logger", "controller", "sensor"]);
    let output = simulate(&system, &["--until", "1s", "--twice"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert!(text(&output.stderr).contains("both simulations did the same\n"), "{}", text(&output.stderr));
    // Whatever happens.
    system.write("rough.yaml", ROUGH);
    let output = simulate(&system, &["--until", "5s", "--scenario", "rough.yaml", "--twice"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("the connections of `"), "{}", text(&output.stderr));
    system.write(OUTSIDE, " ");
    let output = simulate(&system, &["--until", "1s", "--twice"]);
    let err = text(&output.stderr);
    let expected = "error: two simulations with the same seed differ, first 0.000000 s after the first message, at `sensor.values`: message 1 has ";
    assert!(err.contains(expected), "{err}");
    assert_eq!(output.status.code(), Some(1), "{err}");
}

#[test]
fn a_recorded_component_is_played_and_the_others_do_the_same_each_time() {
    if play() {
        return;
    }
    let test = "simulate::components::a_recorded_component_is_played_and_the_others_do_the_same_each_time";
    let system = system(test, &["sensor", "controller", "logger"]);
    let run = |arguments: &[&str]| {
        let output = simulate(&system, &[&["--until", "3s"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    };
    run(&["-o", "flight.mcap"]);
    for output in ["first.mcap", "second.mcap"] {
        run(&["--replay", "flight.mcap", "--as", "sensor", "-o", output]);
    }
    assert!(fs::read(system.path("first.mcap")).unwrap() == fs::read(system.path("second.mcap")).unwrap());
    let compared = system.scl(&["compare", "flight.mcap", "first.mcap", "--gate", "sensor.values"]).output().unwrap();
    // The recorder may find the player after its first message.
    let report = text(&compared.stdout);
    assert!(report.starts_with("sensor.values: 0 of 2"), "{report}");

    let output = simulate(&system, &["--replay", "flight.mcap", "--as", "sensr"]);
    assert!(text(&output.stderr).contains("unknown component `sensr` in `--as`"), "{}", text(&output.stderr));
    assert_eq!(output.status.code(), Some(2));
}
