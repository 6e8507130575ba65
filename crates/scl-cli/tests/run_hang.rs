//! `alive_within` with components of SCL that hang in a computation: `scl run` notices, restarts them, and their peers
//! get messages again.

use crate::system::{System, without_times};
use scl::bytes::Bytes;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use std::fs::OpenOptions;
use std::hint::spin_loop;
use std::io::Write;
use std::thread;
use std::time::Duration;

const TOPOLOGY: &str = "\
system: hang
components:
  - name: sensor
    gates:
      - values: pub
  - name: controller
    gates:
      - values: sub
connections:
  - [sensor.values, controller.values]
";

/// Names the program that a process is.
const PLAYS: &str = "SCL_TEST_HANG_PLAYS";

/// How many messages the sensor sends before it hangs, and in which of its runs it does. That its second run is found
/// hanging as well shows that `scl run` was told that this one was ready, too: only then it is watched.
const MESSAGES: usize = 5;
const HANGING_RUNS: usize = 2;

const READY: Duration = Duration::from_secs(300);
const PERIOD: Duration = Duration::from_millis(10);

#[test]
fn a_blocking_component_that_hangs_is_restarted() {
    match std::env::var(PLAYS).as_deref() {
        Ok("sensor") => sense(),
        Ok(_) => control(),
        Err(_) => check("run_hang::a_blocking_component_that_hangs_is_restarted"),
    }
}

#[test]
fn an_async_component_that_hangs_is_restarted() {
    let current_thread = || tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    match std::env::var(PLAYS).as_deref() {
        Ok("sensor") => current_thread().block_on(sense_async()),
        Ok(_) => control(),
        Err(_) => check("run_hang::an_async_component_that_hangs_is_restarted"),
    }
}

/// Runs a system whose programs are the test of this name in processes of their own.
#[track_caller]
fn check(test: &str) {
    let program = std::env::current_exe().unwrap();
    let command = format!("[{program:?}, --exact, {test}, --nocapture, --test-threads, 2]");
    let launch = format!(
        "\
components:
  sensor: {{command: {command}, environment: {{{PLAYS}: sensor}}, alive_within: 1s, restart: on_failure}}
  controller: {{command: {command}, environment: {{{PLAYS}: controller}}}}
"
    );
    let system = System::of_files(&[("topology.yaml", TOPOLOGY), ("launch.yaml", &launch)]);
    let plan = system.scl(&["plan"]).output().unwrap();
    assert!(plan.status.success(), "{}", String::from_utf8_lossy(&plan.stderr));
    system.write("plan.json", &String::from_utf8(plan.stdout).unwrap());

    // Ends, so that a watchdog that does nothing makes the test fail and not hang.
    let mut run = system.start(&["--for", "2m"]);
    for number in 1..=HANGING_RUNS {
        run.wait_for_line(&format!("controller | run {number}, message 0"));
        run.wait_for_error("sensor      no sign of life for 1s");
        run.wait_for_error("sensor      killed by signal 6 (SIGABRT) after ");
        run.wait_for_error("sensor      restarting in ");
    }
    // Past the point where the earlier runs hang.
    run.wait_for("controller | run 3, message 20");
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    let expected = "scl: component `sensor` was restarted twice; last reason: no sign of life for 1s\n";
    assert!(without_times(&err).contains(expected), "{err}");
    assert_eq!(status.code(), Some(0), "{err}");
}

fn sense() {
    scl::host::notify_service_manager();
    let run = count_run();
    let mut sensor = Component::open_blocking(&plan("sensor")).unwrap();
    sensor.ready_blocking(READY).unwrap();
    let mut values = sensor.publisher("values").unwrap();
    for number in 0.. {
        values.send_blocking(&message(run, number)).unwrap();
        hang_in_early_runs(run, number);
        thread::sleep(PERIOD);
    }
}

async fn sense_async() {
    scl::host::notify_service_manager();
    let run = count_run();
    let mut sensor = Component::open(&plan("sensor")).await.unwrap();
    sensor.ready(READY).await.unwrap();
    let mut values = sensor.publisher("values").unwrap();
    for number in 0.. {
        values.send(&message(run, number)).await.unwrap();
        hang_in_early_runs(run, number);
        tokio::time::sleep(PERIOD).await;
    }
}

/// Prints what arrives.
fn control() {
    let mut controller = Component::open_blocking(&plan("controller")).unwrap();
    let mut values = controller.subscriber("values").unwrap();
    while let Ok(message) = values.recv_blocking() {
        println!("{}", String::from_utf8_lossy(&message));
    }
}

fn plan(component: &str) -> scl::plan::Plan {
    let system = SystemPlan::from_json(&std::fs::read_to_string("plan.json").unwrap()).unwrap();
    system.component(component).unwrap().clone()
}

/// Counts the runs of the sensor in a file.
fn count_run() -> usize {
    let mut runs = OpenOptions::new().create(true).append(true).open("runs").unwrap();
    runs.write_all(b".").unwrap();
    std::fs::read("runs").unwrap().len()
}

fn message(run: usize, number: usize) -> Bytes {
    format!("run {run}, message {number}").into()
}

fn hang_in_early_runs(run: usize, number: usize) {
    if run <= HANGING_RUNS && number == MESSAGES {
        loop {
            spin_loop();
        }
    }
}
