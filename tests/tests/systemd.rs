//! A program as a service: this test plays systemd, with the socket of `sd_notify(3)`.

use crate::programs::{SIGNALLED, TWIN};
use rustix::process::Signal;
use scl_tests::{HANG_LIMIT, Process, System};
use std::os::unix::net::UnixDatagram;

/// A service manager, which receives messages of one program.
struct Manager {
    socket: UnixDatagram,
}

impl Manager {
    fn start(system: &System, task: &str) -> (Self, Process) {
        let path = system.runtime_dir().join("notify");
        let socket = UnixDatagram::bind(&path).unwrap();
        socket.set_read_timeout(Some(HANG_LIMIT)).unwrap();
        let path = path.to_str().unwrap();
        let environment = [("NOTIFY_SOCKET", path), ("WATCHDOG_USEC", "200000")];
        let program = system.start_with(SIGNALLED, &["async", task], &environment);
        (Self { socket }, program)
    }

    /// Reads messages up to a line that starts like this.
    fn expect(&self, expected: &str) -> String {
        let mut seen = Vec::new();
        loop {
            let mut datagram = [0; 4096];
            let length = self.socket.recv(&mut datagram).unwrap_or_else(|error| panic!("{error}; seen: {seen:?}"));
            let text = String::from_utf8(datagram[..length].to_vec()).unwrap();
            if let Some(line) = text.lines().find(|line| line.starts_with(expected)) {
                return line.to_owned();
            }
            seen.push(text);
        }
    }
}

/// The promise: a service is ready when its peers are connected, says what it waits for, is alive while it works, and says
/// that it stops.
#[test]
fn a_service_reports_what_systemd_needs_to_know() {
    let system = System::new();
    let (manager, mut program) = Manager::start(&system, "send");
    program.expect("running");
    let status = manager.expect("STATUS=waiting for ");
    assert!(status.contains("`right."), "{status}");
    let mut right = system.start(TWIN, &["right", "current_thread"]);
    right.expect("open");
    manager.expect("READY=1");
    for _ in 0..5 {
        manager.expect("WATCHDOG=1");
    }
    program.signal(Signal::TERM);
    manager.expect("STOPPING=1");
    assert_eq!(program.wait_for_exit().code(), 0);
}
