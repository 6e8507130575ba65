//! Hosts whose clocks disagree.

use crate::fleet::Fleet;
use crate::network::Network;
use std::path::Path;

/// Where Debian has the library that makes a program believe in another time.
const FAKETIME: &str = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";

#[test]
fn a_clock_an_hour_ahead() {
    check("+1h");
}

/// To this host, certificates come from the future.
#[test]
fn a_clock_an_hour_behind() {
    check("-1h");
}

fn check(offset: &str) {
    assert!(Path::new(FAKETIME).exists(), "no {FAKETIME}; install the package faketime");
    // The clock that never jumps is another one there, too.
    let mut network = Network::with_clocks(&["board", "ground"], &[0, 3600]);
    network.hosts[1].environment.extend(
        [("LD_PRELOAD", FAKETIME), ("FAKETIME", offset), ("FAKETIME_DONT_FAKE_MONOTONIC", "1")]
            .map(|(name, value)| (name.to_owned(), value.to_owned())),
    );
    let mut fleet = Fleet::start_on(network);
    fleet.send_all();
    fleet.player("sink").answer_to_next("lossless");
    fleet.network.cable.cut(0);
    std::thread::sleep(std::time::Duration::from_secs(1));
    fleet.mend_and_measure(0, "cut between clocks that disagree");
    fleet.stop_all();
    fleet.exact_accounts();
    fleet.still_works();
}
