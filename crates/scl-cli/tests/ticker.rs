//! A component whose every message the test decides about, and the lines of a command that measures it.

use crate::rover::Rover;
use crate::system::{ChildGuard, SpawnGuarded, kill};
use scl::OpenOptions;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::{ChildStdout, Stdio};
use std::thread;
use std::time::Duration;

/// Its subscriber never runs, so that the queue drops what nobody takes.
const TOPOLOGY: &str = "\
system: rover
components:
  - name: sensor
    gates:
      - ticks: pub
  - name: viewer
    optional: true
    gates:
      - ticks: {sub: , queue: 1, when_full: drop_oldest}
connections:
  - [sensor.ticks, viewer.ticks]
";

/// The component `sensor`, run by this process.
pub(crate) struct Ticker {
    pub(crate) rover: Rover,
    component: Option<Component>,
    ticks: Option<scl::Pub<scl::bytes::Bytes>>,
}

impl Ticker {
    pub(crate) fn start() -> Self {
        let mut ticker = Self { rover: Rover::of(TOPOLOGY), component: None, ticks: None };
        ticker.open();
        ticker
    }

    pub(crate) fn open(&mut self) {
        let plan = std::fs::read_to_string(self.rover.path("plan.json")).unwrap();
        let plan = SystemPlan::from_json(&plan).unwrap();
        let options = OpenOptions::new().runtime_dir(self.rover.runtime_dir()).system("rover");
        let mut component = Component::open_blocking_with(plan.component("sensor").unwrap(), options).unwrap();
        self.ticks = Some(component.publisher("ticks").unwrap());
        self.component = Some(component);
    }

    pub(crate) fn close(&mut self) {
        (self.ticks, self.component) = (None, None);
    }

    /// Sends messages as fast as possible, of 10 to 19 bytes in turn.
    pub(crate) fn send(&mut self, count: usize) {
        for number in 0..count {
            self.ticks.as_mut().unwrap().send_blocking(&vec![0; 10 + number % 10].into()).unwrap();
        }
    }

    /// Sends a message every 5 ms while `is_seen` waits for one to be seen.
    pub(crate) fn tick_until(&mut self, mut is_seen: impl FnMut() -> bool + Send) {
        thread::scope(|scope| {
            let seen = scope.spawn(move || while !is_seen() {});
            while !seen.is_finished() {
                self.send(1);
                thread::sleep(Duration::from_millis(5));
            }
        });
    }
}

/// What `scl hz`, `scl delay` or `scl bw` prints as JSON, line by line.
pub(crate) struct Reports {
    process: ChildGuard,
    lines: BufReader<ChildStdout>,
}

impl Reports {
    pub(crate) fn start(rover: &Rover, arguments: &[&str]) -> Self {
        let mut command = rover.scl(&[arguments, &["--format", "json"]].concat());
        let mut process = command.stdout(Stdio::piped()).spawn_guarded();
        let lines = BufReader::new(process.stdout.take().unwrap());
        Self { process, lines }
    }

    /// The figures of the next interval.
    pub(crate) fn next(&mut self) -> Value {
        let mut line = String::new();
        self.lines.read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: {line}"))
    }

    /// Reads up to an interval without messages.
    pub(crate) fn wait_for_silence(&mut self) {
        while self.next()["messages"] != 0 {}
    }

    /// Waits for messages, and adds up these figures until an interval without messages.
    pub(crate) fn sum_until_silence<const N: usize>(&mut self, keys: [&str; N]) -> [u64; N] {
        let mut sums = [0; N];
        loop {
            let report = self.next();
            if report["messages"] == 0 {
                if sums.iter().any(|sum| *sum > 0) {
                    return sums;
                }
                continue;
            }
            keys.iter().zip(&mut sums).for_each(|(key, sum)| *sum += report[key].as_u64().unwrap());
        }
    }

    pub(crate) fn process_id(&self) -> u32 {
        self.process.id()
    }

    /// Ends the command as Ctrl-C does; the last line, of the whole time.
    pub(crate) fn interrupt(mut self) -> Value {
        kill("-INT", self.process_id());
        let total = std::iter::from_fn(|| Some(self.next())).find(|report| report["total"] == true);
        assert_eq!(self.process.wait().unwrap().code(), Some(0));
        total.unwrap()
    }
}
