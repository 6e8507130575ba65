//! Components, each played by this test program in a process of its own.

pub(crate) mod pace;
mod receiving;
mod sending;

use scl::plan::SystemPlan;
use scl::untyped::{Component, Gate};
use scl_tests::Process;
use std::collections::HashMap;
use std::io::BufRead;
use std::path::Path;
use std::process::Command;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// Set in the process of a component: which one it is.
const PLAYS: &str = "SCL_TEST_PLAYS";
/// Set in the process of a component: the file with the plans of the system.
const PLAN: &str = "SCL_TEST_PLAN";
/// The test that plays a component if it is asked to.
const TEST: &str = "player::components_on_one_host_need_no_gateway";
/// How often a gate that waits looks for commands.
const TICK: Duration = Duration::from_millis(5);
/// How long a component waits for its peers.
const READY: Duration = Duration::from_secs(300);

/// A component in a process of its own. It is killed when dropped.
pub(crate) struct Player {
    process: Process,
    /// Answers that another question was asked before.
    answers: Vec<String>,
}

/// The numbers of an answer, by name.
#[derive(Debug)]
pub(crate) struct Counts(HashMap<String, u64>);

impl Player {
    /// Starts a component; `command` starts this program on its host.
    pub(crate) fn start(mut command: Command, component: &str, plan: &Path) -> Self {
        command.args(["--exact", TEST, "--nocapture", "--test-threads=1"]);
        command.env(PLAYS, component).env(PLAN, plan);
        let mut player = Self { process: Process::spawn(command), answers: Vec::new() };
        player.answer("opened");
        player
    }

    /// Waits until all required peers are connected.
    #[track_caller]
    pub(crate) fn ready(&mut self) {
        assert_eq!(self.ask("ready", ""), "");
    }

    /// Gives a gate a command and returns its answer.
    #[track_caller]
    pub(crate) fn ask(&mut self, gate: &str, command: &str) -> String {
        self.tell(gate, command);
        self.answer(gate)
    }

    /// Gives a gate a command whose answer may take a while.
    pub(crate) fn tell(&mut self, gate: &str, command: &str) {
        self.process.tell(&format!("{gate} {command}"));
    }

    /// Waits for the next answer of a gate.
    #[track_caller]
    pub(crate) fn answer(&mut self, gate: &str) -> String {
        let start = format!("= {gate} ");
        let kept = self.answers.iter().position(|line| line.starts_with(&start));
        let mut line = kept.map(|index| self.answers.remove(index)).unwrap_or_default();
        while !line.starts_with(&start) {
            if line.starts_with("= ") {
                self.answers.push(line);
            }
            line = self.process.next_line();
        }
        line[start.len()..].to_owned()
    }

    /// Waits until a receiving gate gets a message that it has not got yet.
    #[track_caller]
    pub(crate) fn answer_to_next(&mut self, gate: &str) {
        self.ask(gate, "next");
    }

    /// The numbers that a gate answers a command with.
    #[track_caller]
    pub(crate) fn counts(&mut self, gate: &str, command: &str) -> Counts {
        let answer = self.ask(gate, command);
        let pair = |word: &str| {
            let (name, value) = word.split_once('=')?;
            Some((name.to_owned(), value.parse().ok()?))
        };
        Counts(answer.split(' ').filter_map(pair).collect())
    }

    /// Asks again until the answer is the expected one.
    #[track_caller]
    pub(crate) fn wait_for(&mut self, gate: &str, command: &str, expected: impl Fn(&Counts) -> bool) -> Counts {
        let mut counts = self.counts(gate, command);
        let what = format!("`{gate} {command}`");
        scl_tests::wait_until(&what, || {
            let found = expected(&counts);
            if !found {
                counts = self.counts(gate, command);
            }
            found
        });
        counts
    }

    /// Kills the component, which leaves its files behind.
    pub(crate) fn kill(self) {
        self.process.kill();
    }
}

impl Counts {
    #[track_caller]
    pub(crate) fn get(&self, name: &str) -> u64 {
        *self.0.get(name).unwrap_or_else(|| panic!("no `{name}` in {:?}", self.0))
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut counts: Vec<String> = self.0.iter().map(|(name, value)| format!("{name}={value}")).collect();
        counts.sort();
        f.write_str(&counts.join(" "))
    }
}

#[test]
fn components_on_one_host_need_no_gateway() {
    if let Ok(component) = std::env::var(PLAYS) {
        return play(&component);
    }
    crate::direct::check();
}

/// Plays a component until standard input ends.
fn play(name: &str) {
    let plan = std::fs::read_to_string(std::env::var_os(PLAN).unwrap()).unwrap();
    let plan = SystemPlan::from_json(&plan).unwrap();
    let plan = plan.component(name).unwrap();
    let mut component = Component::open_blocking(plan).unwrap();
    let mut gates = HashMap::new();
    let mut threads = Vec::new();
    for gate in &plan.gates {
        let (commands, received) = mpsc::channel();
        let (name, opened) = (gate.name.clone(), component.gate(&gate.name).unwrap());
        threads.push(thread::spawn(move || play_gate(&name, opened, &received)));
        gates.insert(gate.name.clone(), commands);
    }
    // The test harness has begun a line.
    println!("\n= opened ");
    for line in std::io::stdin().lock().lines() {
        let line = line.unwrap();
        let (gate, command) = line.split_once(' ').unwrap();
        match gates.get(gate) {
            Some(gate) => gate.send(command.to_owned()).unwrap(),
            None => {
                let ready = component.ready_blocking(READY);
                println!("= ready {}", ready.err().map(|error| error.to_string()).unwrap_or_default());
            }
        }
    }
    // The threads end with their commands.
    drop(gates);
    threads.into_iter().for_each(|thread| thread.join().unwrap());
    component.close_blocking(READY).unwrap();
}

fn play_gate(name: &str, gate: Gate, commands: &mpsc::Receiver<String>) {
    match gate {
        Gate::Pub(gate) => sending::play(name, gate, commands),
        Gate::Push(gate) => sending::play(name, gate, commands),
        Gate::Sub(gate) => receiving::play(name, gate, commands),
        Gate::Pull(gate) => receiving::play(name, gate, commands),
        Gate::Req(gate) => sending::request(name, gate, commands),
        Gate::Rep(gate) => receiving::reply(name, gate, commands),
        _ => unreachable!("there are six kinds of gate"),
    }
}
