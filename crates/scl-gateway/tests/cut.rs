//! The network is gone for a while, and comes back.

use crate::accounts::{CONTROL, JOBS, LOSSLESS, NEWEST_KEPT, READINGS};
use crate::control_loop::Reference;
use crate::fleet::Fleet;
use crate::long::short_or_long;
use std::thread::sleep;
use std::time::{Duration, Instant};

#[test]
fn a_second_without_network_loses_nothing() {
    check(Duration::from_secs(1));
}

#[test]
fn a_longer_time_without_network_loses_nothing() {
    check(Duration::from_secs(short_or_long(6, 30)));
}

fn check(length: Duration) {
    let mut fleet = Fleet::start();
    fleet.send_all();
    fleet.player("sink").answer_to_next("lossless");
    let reference = Reference::start(&mut fleet);
    fleet.network.cable.cut(0);
    sleep(length);
    let longest_call = reference.compare(&mut fleet, "during the cut");
    assert!(longest_call < length, "a call waited for the network: {longest_call:?}");
    fleet.repair_and_measure(0, &format!("cut of {length:?}"));
    fleet.stop_all();
    fleet.exact_accounts();
    fleet.still_works();
    fleet.gateway("board").assert_runs();
    fleet.gateway("ground").assert_runs();
}

impl Fleet {
    /// Connects a host again and prints how long each gate had to wait for its next message.
    pub(crate) fn repair_and_measure(&mut self, port: usize, what: &str) {
        let gates = ["control", "readings", "lossless", "jobs"];
        for gate in gates {
            // What was on its way when the cable was cut has arrived.
            self.player("sink").tell(gate, "next");
        }
        self.network.cable.repair(port);
        let repaired = Instant::now();
        for gate in gates {
            self.player("sink").answer(gate);
            println!("after a {what}, `{gate}` resumed within {:?}", repaired.elapsed());
        }
    }
}

#[test]
fn queues_keep_over_a_cut_what_they_declare() {
    let mut fleet = Fleet::start();
    fleet.still_works();
    fleet.network.cable.cut(1);
    let sent = 1500;
    for gate in ["control", "readings"] {
        fleet.player("source").ask(gate, &format!("send {sent} 0 200"));
        fleet.player("source").wait_for(gate, "left", |counts| counts.get("left") == 0);
    }
    // These wait when their queues are full, and so does the program.
    for gate in ["lossless", "jobs"] {
        fleet.player("source").ask(gate, &format!("send {sent} 0 200"));
    }
    let before = [CONTROL, READINGS, NEWEST_KEPT].map(|it| fleet.account(it));
    fleet.network.cable.repair(1);
    for gate in ["lossless", "jobs"] {
        fleet.player("source").wait_for(gate, "left", |counts| counts.get("left") == 0);
    }
    let [control, readings, newest_kept] = [CONTROL, READINGS, NEWEST_KEPT].map(|it| fleet.exact_account(it));
    let arrived = |now: &crate::accounts::Account, index: usize| now.received - before[index].received;
    // Of a queue of one, the newest; and no more than what was already in the hands of the gateways.
    let newest = fleet.player("sink").counts("control", "report").get("newest");
    assert_eq!(newest, control.published, "{control:?}");
    assert!(arrived(&control, 0) <= 4, "{control:?} after {:?}", before[0]);
    // The oldest give way.
    let newest = fleet.player("sink").counts("readings", "report").get("newest");
    assert_eq!(newest, readings.published, "{readings:?}");
    assert!((1000..sent).contains(&arrived(&readings, 1)), "{readings:?} after {:?}", before[1]);
    // The newest give way.
    assert!((50..200).contains(&arrived(&newest_kept, 2)), "{newest_kept:?} after {:?}", before[2]);
    let newest = fleet.player("sink").counts("newest_kept", "report").get("newest");
    assert!(newest < newest_kept.published, "{newest_kept:?}, newest {newest}");
    for connection in [LOSSLESS, JOBS] {
        assert_eq!(fleet.exact_account(connection).dropped, 0);
    }
    fleet.still_works();
}

#[test]
fn requests_fail_while_the_network_is_gone_and_their_replies_are_never_mixed_up() {
    let mut fleet = Fleet::start();
    fleet.still_works();
    fleet.network.cable.cut(0);
    let answer = fleet.player("source").counts("question", "call 5 100");
    assert_eq!(["answered", "failed", "wrong"].map(|name| answer.get(name)), [0, 5, 0]);
    fleet.network.cable.repair(0);
    let repaired = Instant::now();
    let answer = fleet.player("source").counts("question", "call 1 60000");
    println!("after a cut, a request was answered within {:?}", repaired.elapsed());
    assert_eq!(["failed", "wrong"].map(|name| answer.get(name)), [0, 0], "{answer:?}");
    let answer = fleet.player("source").counts("question", "call 100 10000");
    assert_eq!(["answered", "failed", "wrong"].map(|name| answer.get(name)), [100, 0, 0], "{answer:?}");
    fleet.still_works();
}
