//! What became of every message: at the sending end published = taken + dropped + lost +
//! waiting, and what was taken has arrived at the other end, once and in order.

use crate::fleet::Fleet;
use crate::player::Counts;
use scl_tests::wait_until;

/// One connection of the system: the sending gate, the receiving one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Connection {
    pub(crate) from: &'static str,
    pub(crate) to: &'static str,
}

/// What became of the messages of a connection.
#[derive(Debug)]
pub(crate) struct Account {
    pub(crate) published: u64,
    /// Of which the receiving program has told that it has taken them. It does not tell for each.
    pub(crate) taken: u64,
    /// By the queue, or replaced in it by a newer one.
    pub(crate) dropped: u64,
    /// On their way when the connection broke: each of them may have arrived, or not.
    pub(crate) lost: u64,
    pub(crate) waiting: u64,
    /// Arrived in the receiving program: what its gate returned, which the program counts itself, and what its gate
    /// dropped.
    pub(crate) received: u64,
}

/// The connections from `source` to `sink`.
pub(crate) const CONNECTIONS: [Connection; 5] = [READINGS, NEWEST_KEPT, CONTROL, LOSSLESS, JOBS];
pub(crate) const READINGS: Connection = Connection { from: "readings", to: "readings" };
pub(crate) const NEWEST_KEPT: Connection = Connection { from: "readings", to: "newest_kept" };
pub(crate) const CONTROL: Connection = Connection { from: "control", to: "control" };
pub(crate) const LOSSLESS: Connection = Connection { from: "lossless", to: "lossless" };
pub(crate) const JOBS: Connection = Connection { from: "jobs", to: "jobs" };

impl Fleet {
    /// What became of the messages so far, as both ends count them.
    ///
    /// # Panics
    /// If the counts contradict each other: this is the test.
    #[track_caller]
    pub(crate) fn account(&mut self, connection: Connection) -> Account {
        let Connection { from, to } = connection;
        let sent = self.player("source").counts(from, &format!("account sink.{to}"));
        let got = self.player("sink").counts(to, "report");
        let [published, taken, dropped, lost, waiting] =
            ["published", "taken", "dropped", "lost", "waiting"].map(|name| sent.get(name));
        let account = Account { published, taken, dropped, lost, waiting, received: arrived(&got) };
        let Account { published, taken, dropped, lost, waiting, .. } = account;
        assert_eq!(published, taken + dropped + lost + waiting, "{connection:?}: {account:?}");
        let wrong = ["out_of_order", "damaged"].map(|name| got.get(name));
        assert_eq!(wrong, [0, 0], "{connection:?}: {account:?}, {got:?}");
        account
    }

    /// The account when all messages have arrived that were not dropped, where `sink` ran all the time and nothing may
    /// be lost.
    #[track_caller]
    pub(crate) fn exact_account(&mut self, connection: Connection) -> Account {
        let mut account = self.account(connection);
        wait_until(&format!("all messages of {connection:?} have arrived"), || {
            account = self.account(connection);
            account.received >= account.published - account.dropped
        });
        assert_eq!(account.lost, 0, "{connection:?}: {account:?}");
        assert_eq!(account.received, account.published - account.dropped, "{connection:?}: {account:?}");
        account
    }

    /// The accounts of all connections. Those that wait have dropped nothing, either.
    #[track_caller]
    pub(crate) fn exact_accounts(&mut self) {
        for connection in CONNECTIONS {
            let account = self.exact_account(connection);
            println!("{connection:?}: {account:?}");
        }
        for connection in [LOSSLESS, JOBS] {
            let account = self.exact_account(connection);
            assert_eq!(account.dropped, 0, "{connection:?}: {account:?}");
        }
    }

    /// All promises once more: a good client still works.
    #[track_caller]
    pub(crate) fn still_works(&mut self) {
        self.player("source").ready();
        self.player("sink").ready();
        let answer = self.player("source").ask("question", "call 20 10000");
        assert!(answer.starts_with("answered=20 failed=0 wrong=0"), "{answer}");
        // What is on its way from before arrives before this one.
        let before = self.deliver(1);
        let after = self.deliver(40);
        for ((connection, before), after) in CONNECTIONS.into_iter().zip(before).zip(after) {
            // Where there is room for one, the sending gate drops, too.
            let expected = if connection.to == "control" { 1..=40 } else { 40..=40 };
            let arrived = after - before;
            assert!(expected.contains(&arrived), "{connection:?}: {arrived} of 40; {:?}", self.account(connection));
        }
    }

    /// Sends `count` messages on each connection. Returns how many have arrived there in total once the last one has.
    #[track_caller]
    fn deliver(&mut self, count: u64) -> [u64; CONNECTIONS.len()] {
        let published = CONNECTIONS.map(|it| self.account(it).published);
        for gate in ["lossless", "jobs", "control", "readings"] {
            self.player("source").ask(gate, &format!("send {count} 0 100"));
        }
        std::array::from_fn(|index| {
            let Connection { from, to } = CONNECTIONS[index];
            let mark = self.player("source").wait_for(from, "left", |counts| counts.get("left") == 0).get("mark");
            let is_last =
                |counts: &Counts| counts.get("newest") == published[index] + count && counts.get("mark") == mark;
            arrived(&self.player("sink").wait_for(to, "report", is_last))
        })
    }

    /// Starts what the tests of faults interrupt: a control loop, readings that may be dropped, and two ways on which
    /// nothing may be.
    pub(crate) fn send_all(&mut self) {
        let source = self.player("source");
        source.ask("control", "send 0 500 64");
        source.ask("readings", "send 0 1000 200");
        source.ask("lossless", "send 0 200 500");
        source.ask("jobs", "send 0 200 500");
    }

    pub(crate) fn stop_all(&mut self) {
        for gate in ["control", "readings", "lossless", "jobs"] {
            self.player("source").ask(gate, "stop");
        }
    }
}

fn arrived(report: &Counts) -> u64 {
    report.get("count") + report.get("dropped") + report.get("waiting")
}
