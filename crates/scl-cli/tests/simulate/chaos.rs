//! Kills, pauses and cuts of peers in random order, while all six kinds of gates are busy: the accounts add up, and
//! what must not be lost is not.
//!
//! `SCL_TEST_SEEDS` is the seeds, such as `1..10000`; otherwise, there are a few, other ones for each commit.

use super::{of_components, plan, simulate, text};
use scl::bytes::Bytes;
use scl::untyped::Component;
use scl::{PeerStats, Pub, Push, Sub};
use std::collections::HashMap;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, SystemTime};

const TOPOLOGY: &str = "\
system: six
components:
  - name: source
    gates:
      - status: {pub: crate.Status, codec: json, unconnected: ok}
      - readings: pub
      - lossless: {pub: , backpressure: true}
      - jobs: {push: , backpressure: true}
      - question: {req: , timeout: 200ms}
  - name: sink
    gates:
      - status: {pub: crate.Status, codec: json, unconnected: ok}
      - readings: {sub: , queue: 100}
      - newest: {sub: , queue: 1}
      - lossless: {sub: , queue: 10, when_full: wait}
      - jobs: {pull: , queue: 100, when_full: wait}
      - answer: rep
  - name: watcher
    gates:
      - status: {pub: crate.Status, codec: json, unconnected: ok}
      - readings: {sub: , queue: 3}
connections:
  - [source.readings, sink.readings]
  - [source.readings, sink.newest]
  - [source.readings, watcher.readings]
  - [source.lossless, sink.lossless]
  - [source.jobs, sink.jobs]
  - [source.question, sink.answer]
";

const SCENARIO: &str = "\
until: 4s
delays: {source.*: 0ms..3ms, sink.answer: 1ms}
takes: {sink: 0ms..8ms, watcher: 0ms..20ms}
faults:
  - {every: 100ms..1500ms, kill: any}
  - {every: 100ms..1500ms, cut: any, for: 1ms..700ms}
  - {every: 300ms..2s, pause: any, for: 1ms..500ms}
expect:
  - {always: source.status, where: ok}
  - {always: sink.status, where: ok}
  - {always: watcher.status, where: ok}
  - {eventually: source.status, where: 'count > 300'}
  - {eventually: sink.status, where: 'count > 300'}
";

/// Names the program that a process is.
const PLAYS: &str = "SCL_TEST_CHAOS_PLAYS";
const MS: Duration = Duration::from_millis(1);
/// Seeds of one run of the test.
const SEEDS: u64 = 10;

#[test]
fn accounts_add_up_through_kills_pauses_and_cuts() {
    if let Ok(name) = std::env::var(PLAYS) {
        return play(&name);
    }
    let test = "simulate::chaos::accounts_add_up_through_kills_pauses_and_cuts";
    let system = of_components(TOPOLOGY, test, PLAYS, &["source", "sink", "watcher"]);
    system.write("chaos.yaml", SCENARIO);
    let seeds = std::env::var("SCL_TEST_SEEDS").unwrap_or_else(|_| seeds_of_this_commit());
    println!("seeds {seeds}");
    let output = simulate(&system, &["--scenario", "chaos.yaml", "--seeds", &seeds, "--jobs", "2"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
}

/// Other ones for each commit, and the same whenever it is tested.
fn seeds_of_this_commit() -> String {
    let hash = Command::new("git").args(["rev-parse", "--short=8", "HEAD"]).output();
    let hash = hash.ok().and_then(|output| u64::from_str_radix(text(&output.stdout).trim(), 16).ok());
    let first = hash.unwrap_or(1);
    format!("{first}..{}", first + SEEDS - 1)
}

/// What has gone wrong in a program, and how many messages it has sent or received.
#[derive(Debug, Default)]
struct Status {
    wrong: Option<String>,
    count: u64,
}

type Shared = Arc<Mutex<Status>>;

fn play(name: &str) {
    let mut component = Component::open_blocking(&plan(name)).unwrap();
    let status = Shared::default();
    match name {
        "source" => send_all(&mut component, &status),
        _ => receive_all(&mut component, name, &status),
    }
    let mut gate = component.publisher("status").unwrap();
    loop {
        thread::sleep(20 * MS);
        let text = {
            let status = status.lock().unwrap();
            serde_json::json!({"ok": status.wrong.is_none(), "wrong": status.wrong, "count": status.count}).to_string()
        };
        if gate.send_blocking(&text.into()).is_err() {
            return;
        }
    }
}

/// A number of a process, which later ones exceed.
fn birth() -> u128 {
    SystemTime::UNIX_EPOCH.elapsed().unwrap().as_nanos()
}

/// Sends on each gate, each message with its number.
fn send_all(component: &mut Component, status: &Shared) {
    let born = birth();
    let message = move |number: u64| Bytes::from(format!("{born} {number}"));
    let send = |gate: Sender, every: Duration, waits: bool| {
        let checked = Arc::clone(status);
        thread::spawn(move || gate.send_all(message, every, waits, &checked));
    };
    send(Sender::Pub(component.publisher("readings").unwrap()), MS, false);
    send(Sender::Pub(component.publisher("lossless").unwrap()), 2 * MS, true);
    send(Sender::Push(component.pusher("jobs").unwrap()), 3 * MS, true);
    let mut question = component.requester("question").unwrap();
    let checked = Arc::clone(status);
    thread::spawn(move || {
        for number in 0.. {
            thread::sleep(10 * MS);
            let asked = message(number);
            if question.call_blocking(&asked).is_ok_and(|answer| answer != asked) {
                checked.lock().unwrap().wrong = Some(format!("question {number} has another answer"));
            }
        }
    });
}

enum Sender {
    Pub(Pub<Bytes>),
    Push(Push<Bytes>),
}

impl Sender {
    fn send_all(mut self, message: impl Fn(u64) -> Bytes, every: Duration, waits: bool, status: &Shared) {
        let mut accounts = Accounts::default();
        for number in 0.. {
            thread::sleep(every);
            let (sent, now) = match &mut self {
                Self::Pub(gate) => (gate.send_blocking(&message(number)), gate.peer_stats()),
                Self::Push(gate) => (gate.send_blocking(&message(number)), gate.peer_stats()),
            };
            if sent.is_err() {
                return;
            }
            accounts.check(&now, waits, status);
        }
    }
}

/// The accounts of a gate's connections, as they were last.
#[derive(Default)]
struct Accounts(Vec<PeerStats>);

impl Accounts {
    /// Each message is in one place, what was counted stays counted, and a gate that waits drops nothing.
    fn check(&mut self, now: &[PeerStats], waits: bool, status: &Shared) {
        let is_balanced = |it: &PeerStats| {
            it.published == it.taken + it.replaced + it.dropped_oldest + it.dropped_newest + it.lost + it.waiting
        };
        let is_kept = |(before, it): (&PeerStats, &PeerStats)| {
            it.taken >= before.taken && it.lost >= before.lost && it.published >= before.published
        };
        let nothing_dropped = |it: &PeerStats| it.dropped_oldest == 0 && it.dropped_newest == 0;
        let mut status = status.lock().unwrap();
        status.count += 1;
        if !now.iter().all(|it| is_balanced(it) && (!waits || nothing_dropped(it)))
            || !self.0.iter().zip(now).all(is_kept)
        {
            status.wrong.get_or_insert(format!("{now:?} after {:?}", self.0));
        }
        self.0 = now.to_vec();
    }
}

/// Receives on each gate.
fn receive_all(component: &mut Component, name: &str, status: &Shared) {
    follow(component.subscriber("readings").unwrap(), false, status);
    if name != "sink" {
        return;
    }
    follow(component.subscriber("newest").unwrap(), false, status);
    follow(component.subscriber("lossless").unwrap(), true, status);
    let (mut jobs, checked) = (component.puller("jobs").unwrap(), Arc::clone(status));
    thread::spawn(move || {
        let mut order = Order::default();
        while let Ok(message) = jobs.recv_blocking() {
            order.check(&message, true, &checked);
        }
    });
    let mut answer = component.replier("answer").unwrap();
    thread::spawn(move || {
        while let Ok(request) = answer.recv_blocking() {
            let asked = request.message().clone();
            // The requester may be gone.
            let _gone = request.reply(&asked);
        }
    });
}

fn follow(mut gate: Sub<Bytes>, is_complete: bool, status: &Shared) {
    let checked = Arc::clone(status);
    thread::spawn(move || {
        let mut order = Order::default();
        while let Ok(message) = gate.recv_blocking() {
            order.check(&message, is_complete, &checked);
        }
    });
}

/// The last number from each process that has sent.
#[derive(Default)]
struct Order(HashMap<u128, u64>);

impl Order {
    /// Messages come in order, each once, and without gaps if the sender waits.
    fn check(&mut self, message: &Bytes, is_complete: bool, status: &Shared) {
        let message = text(message);
        let (born, number) = message.split_once(' ').unwrap();
        let (born, number): (u128, u64) = (born.parse().unwrap(), number.parse().unwrap());
        let mut status = status.lock().unwrap();
        status.count += 1;
        let is_right =
            self.0.get(&born).is_none_or(|last| if is_complete { number == last + 1 } else { number > *last });
        if !is_right {
            status.wrong.get_or_insert(format!("{number} after {:?} of {born}", self.0.get(&born)));
        }
        self.0.insert(born, number);
    }
}
