//! Two hosts and a network without faults: everything arrives at the rate at which it is sent.

use crate::accounts::{CONNECTIONS, CONTROL, JOBS, LOSSLESS, READINGS};
use crate::control_loop::Reference;
use crate::fleet::Fleet;
use crate::long::is_long;
use std::time::Instant;

#[test]
fn a_good_network_delivers_everything_in_time() {
    let mut fleet = Fleet::start();
    fleet.still_works();
    let reference = Reference::start(&mut fleet);
    let before = CONNECTIONS.map(|it| fleet.account(it));
    fleet.send_all();
    let started = Instant::now();
    // A loop that sends 500 times in a second has run for two seconds.
    fleet
        .player("source")
        .wait_for("control", "account sink.control", |counts| counts.get("published") >= before[2].published + 1000);
    let took = started.elapsed();
    let _longest_call = reference.compare(&mut fleet, "without faults");
    for (connection, before) in CONNECTIONS.into_iter().zip(&before) {
        let now = fleet.account(connection);
        let (published, received) = (now.published - before.published, now.received - before.received);
        println!("{connection:?} in {took:?}: {published} published, {received} received, {now:?}");
    }
    fleet.stop_all();
    fleet.exact_accounts();
    for connection in [READINGS, LOSSLESS, JOBS] {
        let account = fleet.account(connection);
        assert_eq!(account.dropped, 0, "{connection:?}: {account:?}");
    }
    for host in ["board", "ground"] {
        let log = fleet.gateway(host).log();
        assert!(!log.contains("not connected any more"), "the gateways lost each other on a good network:\n{log}");
    }
    // To a queue of one goes one message at a time, the newest then; the others give way to newer ones.
    let control = fleet.account(CONTROL);
    assert!(control.received - before[2].received > 20, "{control:?}");
    // The rates are those of `send_all`; a network that delays each message by its own round trip would not keep them
    // up.
    let lossless = fleet.account(LOSSLESS).published - before[3].published;
    assert!(!is_long() || lossless as f64 > 0.5 * 200.0 * took.as_secs_f64(), "{lossless} in {took:?}");
}
