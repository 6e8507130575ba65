//! Kills, orderly ends and pauses of both peers in random order, while all six kinds of gates are busy: the accounts
//! add up.
//!
//! `SCL_TEST_KILLS` is the number of these events over each transport.

use crate::accounts::Account;
use crate::programs::open;
use scl::TransportKind;
use scl_tests::fuzz::Generator;
use scl_tests::{Process, System};
use std::thread::park_timeout;
use std::time::Duration;

/// Connections from the source to the sink.
const GATES: [&str; 4] = ["readings", "newest", "lossless", "jobs"];
/// Those on which a sender waits instead of dropping messages.
const LOSSLESS: [&str; 2] = ["lossless", "jobs"];

#[test]
fn accounts_add_up_whatever_happens_to_the_peers() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp, TransportKind::Shm] {
        let system = System::over(kind);
        let mut chaos = Chaos::new(&system);
        for _ in 0..events() {
            chaos.happen();
        }
        chaos.end();
        assert_eq!(system.shared_files("six"), Vec::<std::path::PathBuf>::new());
    }
}

/// How many events there are: 40, or `SCL_TEST_KILLS`.
fn events() -> usize {
    std::env::var("SCL_TEST_KILLS").map_or(40, |number| number.parse().expect("a number"))
}

struct Chaos<'s> {
    system: &'s System,
    generator: Generator,
    source: Option<Process>,
    sink: Option<Process>,
    /// Takes readings all the time, so that an ending source hands over all of its messages.
    watcher: Process,
    /// How many sources have been started.
    sources: u64,
    /// The accounts of the source before the sink was started, in the order of [`GATES`]. `None` if the source is
    /// younger than the sink.
    before: Option<[Account; 4]>,
}

impl<'s> Chaos<'s> {
    fn new(system: &'s System) -> Self {
        let (generator, mut watcher) = (Generator::new(19), open(system, "watcher"));
        watcher.tell(&format!("receive_up_to {}", u64::MAX));
        let mut chaos = Self { system, generator, source: None, sink: None, watcher, sources: 0, before: None };
        chaos.start_source();
        chaos.start_sink();
        chaos
    }

    fn start_source(&mut self) {
        self.source = Some(open(self.system, "source"));
        self.sources += 1;
        self.before = None;
        self.send();
    }

    fn start_sink(&mut self) {
        let mut sink = open(self.system, "sink");
        sink.tell("busy");
        self.sink = Some(sink);
    }

    fn send(&mut self) {
        // Beyond 16 KiB, messages use shared memory if they can.
        let padding = [0, 100, 5_000, 40_000][self.generator.below(4)];
        let number = self.sources;
        self.source().tell(&format!("busy {number} {padding}"));
    }

    fn source(&mut self) -> &mut Process {
        self.source.as_mut().expect("a source")
    }

    fn happen(&mut self) {
        self.moment();
        match self.generator.below(8) {
            0..=2 => self.kill_sink(),
            3..=5 => self.end_sink(),
            6 => self.replace_source(),
            _ => {
                let paused = if self.generator.below(2) == 0 { &self.sink } else { &self.source };
                let paused = paused.as_ref().expect("a program");
                paused.pause();
                park_timeout(Duration::from_micros(self.generator.below(50_000) as u64));
                paused.resume();
            }
        }
    }

    /// Nothing depends on how long this is: events come from before peers are connected to long after.
    fn moment(&mut self) {
        park_timeout(Duration::from_micros(self.generator.below(100_000) as u64));
    }

    fn kill_sink(&mut self) {
        self.sink.take().expect("a sink").kill();
        self.check(None);
        self.start_sink();
    }

    /// Ends the sink in order, which says how many messages it has taken.
    fn end_sink(&mut self) {
        let exit = self.sink.take().expect("a sink").wait_for_exit();
        assert!(exit.status.success(), "{exit:?}");
        let line = exit.output.last().expect("what the sink has taken");
        let numbers: Vec<u64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
        self.check(Some(numbers.try_into().expect("four numbers")));
        self.start_sink();
    }

    /// Checks the accounts after the end of a sink that has said what it has taken, or was killed.
    #[track_caller]
    fn check(&mut self, taken: Option<[u64; 4]>) {
        let source = self.source();
        source.ask("alone 1", "alone");
        let now = GATES.map(|gate| Account::of(source, gate));
        for (index, (gate, account)) in GATES.iter().zip(&now).enumerate() {
            account.assert_balanced();
            assert!(account.dropped == 0 || !LOSSLESS.contains(gate), "{gate}: {account:?}");
            let Some(before) = &self.before else { continue };
            let before = &before[index];
            assert!(
                account.taken >= before.taken && account.lost >= before.lost,
                "{gate}: {account:?} after {before:?}"
            );
            if let Some(taken) = taken {
                assert_eq!(account.taken - before.taken, taken[index], "{gate}: {account:?} after {before:?}");
            }
        }
        self.before = Some(now);
        self.send();
    }

    /// Kills the source or ends it in order, and starts its successor. The sink goes on.
    fn replace_source(&mut self) {
        let source = self.source.take().expect("a source");
        if self.generator.below(2) == 0 {
            source.kill();
        } else {
            let exit = source.wait_for_exit();
            assert!(exit.status.success(), "{exit:?}");
        }
        self.start_source();
    }

    fn end(self) {
        for program in [self.source, self.sink].into_iter().flatten() {
            let exit = program.wait_for_exit();
            assert!(exit.status.success(), "{exit:?}");
        }
        self.watcher.kill();
    }
}
