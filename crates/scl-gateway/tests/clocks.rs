//! Hosts whose clocks disagree.

use crate::fleet::Fleet;
use crate::network::Network;
use std::path::PathBuf;

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
    // The clock that never jumps is another one there, too.
    let mut network = Network::with_clocks(&["board", "ground"], &[0, 3600]);
    network.hosts[1].environment = believing_in(offset).into();
    let mut fleet = Fleet::start_on(network);
    fleet.send_all();
    fleet.player("sink").answer_to_next("lossless");
    fleet.network.cable.cut(0);
    std::thread::sleep(std::time::Duration::from_secs(1));
    fleet.repair_and_measure(0, "cut between clocks that disagree");
    fleet.stop_all();
    fleet.exact_accounts();
    fleet.still_works();
}

/// The environment of programs that believe in another time: `+1h`, `-1h` or `@2000-01-01 00:00:00`.
pub(crate) fn believing_in(time: &str) -> [(String, String); 3] {
    let library = library().to_string_lossy().into_owned();
    let variables = [("LD_PRELOAD", &*library), ("FAKETIME", time), ("FAKETIME_DONT_FAKE_MONOTONIC", "1")];
    variables.map(|(name, value)| (name.to_owned(), value.to_owned()))
}

/// Where Debian has it: in the folder of the architecture.
fn library() -> PathBuf {
    let folders = std::fs::read_dir("/usr/lib").unwrap();
    let mut files = folders.map(|folder| folder.unwrap().path().join("faketime/libfaketime.so.1"));
    files.find(|file| file.exists()).expect("libfaketime.so.1; install the package faketime")
}
