//! Programs on the network that have no certificate: they get nothing, and do no damage.

mod attacks;

use crate::fleet::Fleet;
use crate::host::Host;
use crate::network::Network;
use scl_tests::Process;
use std::time::Instant;

/// Set in the process of a stranger: what it does.
const ATTACK: &str = "SCL_TEST_STRANGER";
/// Set in the process of a stranger: the certificate of the authority, which is no secret.
const AUTHORITY: &str = "SCL_TEST_AUTHORITY";
/// Set in the process of a stranger: the address of a gateway.
const GATEWAY: &str = "SCL_TEST_GATEWAY";

/// File descriptors of a gateway at most: unfinished handshakes, and all that it needs.
const MOST_DESCRIPTORS: usize = 256 + 64 + 100;

const TEST: &str = "strangers::bytes_that_are_not_tls_do_no_damage";

#[test]
fn bytes_that_are_not_tls_do_no_damage() {
    match std::env::var(ATTACK) {
        Ok(attack) => attacks::run(&attack),
        Err(_) => check("garbage"),
    }
}

#[test]
fn a_client_without_a_certificate_is_refused() {
    check("no-certificate");
}

#[test]
fn a_client_with_a_certificate_of_its_own_is_refused() {
    check("untrusted-certificate");
}

#[test]
fn connections_that_break_off_keep_nobody_out() {
    check("break-off");
}

#[test]
fn connections_on_which_a_handshake_only_begins_keep_nobody_out() {
    check("half-hello");
}

#[test]
fn handshakes_that_come_byte_by_byte_keep_nobody_out() {
    check("byte-by-byte");
}

#[test]
fn connections_on_which_nothing_is_said_keep_nobody_out() {
    check("silence");
}

fn check(attack: &str) {
    let mut fleet = Fleet::start_on(Network::new(&["board", "ground", "stranger"]));
    // Half of the network's addresses are the stranger's.
    fleet.network.host("stranger").run("ip route add local 10.77.0.128/25 dev lo");
    let authority = fleet.files.path("keys/board/authority.pem");
    fleet.send_all();
    let addresses = ["board", "ground"].map(|name| fleet.network.host(name).socket_address());
    let attackers = addresses.map(|address| {
        let mut attacker = start(fleet.network.host("stranger"), attack, &address, &authority);
        attacker.expect_containing("= begun");
        attacker
    });
    // While that goes on, a component starts anew and is let in.
    fleet.kill("sink");
    fleet.play("sink");
    fleet.player("sink").ready();
    for host in ["board", "ground"] {
        let descriptors = fleet.gateway(host).descriptors();
        assert!(descriptors < MOST_DESCRIPTORS, "the gateway of `{host}` has {descriptors} file descriptors");
    }
    // And so is a gateway.
    for host in ["ground", "board"] {
        fleet.kill_gateway(host);
        fleet.start_gateway(host);
        let started = Instant::now();
        fleet.player("sink").answer_to_next("lossless");
        println!("{attack}: resumed within {:?} of the start of `{host}`", started.elapsed());
    }
    for attacker in attackers {
        let exit = attacker.wait_for_exit();
        assert_eq!(exit.code(), 0, "{}", exit.text());
    }
    fleet.stop_all();
    fleet.still_works();
    fleet.gateway("board").assert_runs();
    fleet.gateway("ground").assert_runs();
}

fn start(host: &Host, attack: &str, address: &str, authority: &std::path::Path) -> Process {
    let mut command = host.command(std::env::current_exe().unwrap());
    command.args(["--exact", TEST, "--nocapture", "--test-threads=1"]);
    command.env(ATTACK, attack).env(AUTHORITY, authority).env(GATEWAY, address);
    Process::spawn(command)
}
