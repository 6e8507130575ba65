//! Gateways and components that are killed (SIGKILL) and started again.

use crate::accounts::{Account, CONNECTIONS, Connection, JOBS, LOSSLESS};
use crate::control_loop::Reference;
use crate::fleet::Fleet;
use crate::long::short_or_long;
use std::time::Instant;

#[test]
fn a_gateway_that_is_killed_where_messages_come_from() {
    check("board");
}

#[test]
fn a_gateway_that_is_killed_where_messages_go() {
    check("ground");
}

fn check(host: &str) {
    let kills = short_or_long(5, 100);
    let mut fleet = Fleet::start();
    fleet.send_all();
    fleet.player("sink").answer_to_next("lossless");
    let reference = Reference::start(&mut fleet);
    let mut longest = std::time::Duration::ZERO;
    for _ in 0..kills {
        fleet.kill_gateway(host);
        fleet.start_gateway(host);
        let started = Instant::now();
        for gate in ["control", "lossless", "jobs", "readings"] {
            fleet.player("sink").answer_to_next(gate);
        }
        longest = longest.max(started.elapsed());
    }
    println!("{kills} kills of the gateway of `{host}`: all resumed within {longest:?}");
    let _longest_call = reference.compare(&mut fleet, "during the kills");
    fleet.stop_all();
    for connection in CONNECTIONS {
        let account = fleet.account_after(connection);
        if [LOSSLESS.to, JOBS.to].contains(&connection.to) {
            assert_eq!(account.dropped, 0, "{connection:?}: {account:?}");
        }
    }
    fleet.still_works();
}

#[test]
fn a_gateway_that_is_stopped_in_order() {
    let mut fleet = Fleet::start();
    fleet.send_all();
    for host in ["board", "ground"] {
        fleet.player("sink").answer_to_next("lossless");
        let status = fleet.stop_gateway(host);
        assert!(status.success(), "{status}");
        fleet.start_gateway(host);
        fleet.player("sink").answer_to_next("lossless");
    }
    fleet.stop_all();
    for connection in CONNECTIONS {
        fleet.account_after(connection);
    }
    fleet.still_works();
}

impl Fleet {
    /// The account after programs were killed that held messages. Whether those arrived is unknown, but a gateway that
    /// gave them up has counted them. What was published and is not counted has arrived.
    #[track_caller]
    pub(crate) fn account_after(&mut self, connection: Connection) -> Account {
        let (mut account, mut given_up) = (self.account(connection), 0);
        scl_tests::wait_until(&format!("what is left of {connection:?} has arrived"), || {
            account = self.account(connection);
            // A gateway knows it when the next one has taken the place of the one that is gone.
            given_up = self.given_up(connection);
            account.received + account.lost + given_up >= account.published - account.dropped
        });
        println!("{connection:?}: {account:?}, {given_up} given up by gateways");
        assert!(account.received <= account.published - account.dropped, "{connection:?}: {account:?}");
        account
    }

    /// How many messages the gateways have given up, by their logs.
    fn given_up(&mut self, connection: Connection) -> u64 {
        let to = format!("to sink.{} were on their way", connection.to);
        let logs = ["board", "ground"].map(|host| self.gateway(host).log());
        let lines = logs.iter().flat_map(|log| log.lines()).filter(|line| line.contains(&to));
        lines.flat_map(|line| line.split(' ')).filter_map(|word| word.parse::<u64>().ok()).sum()
    }
}

#[test]
fn a_receiving_component_that_is_killed() {
    let mut fleet = Fleet::start();
    fleet.send_all();
    fleet.player("sink").answer_to_next("lossless");
    let reference = Reference::start(&mut fleet);
    for _ in 0..short_or_long(3, 30) {
        fleet.kill("sink");
        fleet.play("sink");
        let started = Instant::now();
        for gate in ["control", "lossless", "jobs", "readings"] {
            fleet.player("sink").answer_to_next(gate);
        }
        println!("a new `sink` gets messages within {:?}", started.elapsed());
    }
    let _longest_call = reference.compare(&mut fleet, "during the kills");
    fleet.stop_all();
    for connection in CONNECTIONS {
        let account = fleet.account(connection);
        assert!(account.received <= account.published - account.dropped, "{connection:?}: {account:?}");
    }
    fleet.still_works();
}

#[test]
fn a_sending_component_that_is_killed() {
    let mut fleet = Fleet::start();
    for _ in 0..short_or_long(3, 30) {
        fleet.send_all();
        fleet.player("sink").answer_to_next("lossless");
        fleet.kill("source");
        fleet.play("source");
        let started = Instant::now();
        fleet.player("source").ready();
        println!("a new `source` is ready within {:?}", started.elapsed());
    }
    // Of several senders in a row, too, everything came in order.
    for gate in ["control", "readings", "newest_kept", "lossless", "jobs"] {
        let report = fleet.player("sink").counts(gate, "report");
        assert_eq!(["out_of_order", "damaged"].map(|name| report.get(name)), [0, 0], "{gate}: {report:?}");
    }
    fleet.still_works();
}

#[test]
fn several_components_push_to_another_host() {
    let mut fleet = Fleet::start();
    fleet.play("helper").ready();
    for component in ["source", "helper"] {
        fleet.player(component).ask("jobs", "send 500 0 300");
    }
    let report = fleet.player("sink").wait_for("jobs", "report", |counts| counts.get("count") == 1000);
    assert_eq!(["out_of_order", "gaps", "damaged"].map(|name| report.get(name)), [0, 0, 0], "{report:?}");
    fleet.kill("helper");
    fleet.still_works();
}

/// With the folder, all sockets and locks are gone. As on one host, programs that start again find each other.
#[test]
fn a_runtime_folder_that_is_removed() {
    for host in ["board", "ground"] {
        let mut fleet = Fleet::start();
        fleet.still_works();
        std::fs::remove_dir_all(fleet.network.host(host).runtime_dir()).unwrap();
        let component = if host == "board" { "source" } else { "sink" };
        fleet.kill(component);
        fleet.play(component).ready();
        fleet.still_works();
    }
}
