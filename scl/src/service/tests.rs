//! What a service manager is told, received by a socket of the test.

use super::*;
use std::os::unix::net::UnixDatagram;
use tempfile::TempDir;

const LONG: Duration = Duration::from_secs(3600);

struct Manager {
    socket: UnixDatagram,
    _folder: TempDir,
    service: Arc<Service>,
}

impl Manager {
    fn new(watchdog: Option<Duration>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let socket = UnixDatagram::bind(&path).unwrap();
        socket.set_nonblocking(true).unwrap();
        let service = Arc::new(Service::new(Socket::connect(path.as_os_str()).unwrap(), watchdog));
        Self { socket, _folder: folder, service }
    }

    /// Everything that was sent since the last time.
    fn heard(&self) -> String {
        let (mut text, mut buffer) = (String::new(), [0; 4096]);
        while let Ok(length) = self.socket.recv(&mut buffer) {
            text.push_str(std::str::from_utf8(&buffer[..length]).unwrap());
        }
        text
    }
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

#[test]
fn a_process_is_ready_when_all_members_have_been() {
    let manager = Manager::new(None);
    let [first, second] = [manager.service.join(true), manager.service.join(false)];
    first.report_missing(names(&["a.b", "line\nbreak"]));
    assert_eq!(manager.heard(), "STATUS=waiting for `a.b`, `line\\nbreak`\n");
    first.report_missing(names(&["a.b", "line\nbreak"]));
    assert_eq!(manager.heard(), "");
    first.report_missing(names(&[]));
    assert_eq!(manager.heard(), "STATUS=all required peers are connected\n");
    second.report_missing(names(&["c.d"]));
    assert_eq!(manager.heard(), "STATUS=waiting for `c.d`\n");
    // Once is enough.
    first.report_missing(names(&["a.b"]));
    second.report_missing(names(&[]));
    assert_eq!(manager.heard(), "STATUS=waiting for `a.b`, `c.d`\nREADY=1\nSTATUS=waiting for `a.b`\n");
    drop(first);
    second.report_missing(names(&["0", "1", "2", "3", "4", "5", "6", "7", "8", "9"]));
    assert!(manager.heard().ends_with("`6`, `7` and 2 more\n"));
    manager.service.report_stopping();
    manager.service.report_stopping();
    second.called();
    second.tick(|| true);
    assert_eq!(manager.heard(), "STOPPING=1\n");
}

#[test]
fn a_member_without_peers_is_ready_at_once() {
    let manager = Manager::new(None);
    manager.service.join(true).report_missing(names(&[]));
    assert_eq!(manager.heard(), "READY=1\nSTATUS=all required peers are connected\n");
}

#[test]
fn a_member_that_follows_calls_is_alive_while_it_calls_or_waits() {
    let manager = Manager::new(Some(LONG));
    let member = manager.service.join(true);
    let alive = |waits: bool| {
        member.tick(|| waits);
        manager.heard() == "WATCHDOG=1\n"
    };
    assert!(alive(false) && alive(false), "it has not called a gate yet");
    member.called();
    member.called();
    assert_eq!(manager.heard(), "", "the last report is not old enough");
    assert!(alive(false), "it has called");
    assert!(!alive(false) && !alive(false), "it has not called since");
    assert!(alive(true) && alive(true), "a call waits");
    let waiting = member.wait();
    assert!(alive(false) && alive(false), "a call waits that was counted");
    drop(waiting);
    assert!(!alive(false));
    member.called();
    assert!(alive(false), "it calls again");
}

#[test]
fn a_call_reports_at_once_when_a_report_is_due() {
    let manager = Manager::new(Some(Duration::from_nanos(2)));
    let member = manager.service.join(true);
    for _ in 0..3 {
        member.called();
        assert_eq!(manager.heard(), "WATCHDOG=1\n");
        member.tick(|| false);
        assert_eq!(manager.heard(), "");
    }
}

#[test]
fn a_process_is_alive_while_all_members_are() {
    let manager = Manager::new(Some(LONG));
    let [follows, ticks] = [manager.service.join(true), manager.service.join(false)];
    follows.called();
    assert_eq!(manager.heard(), "", "the other has shown no life");
    ticks.tick(|| false);
    assert_eq!(manager.heard(), "WATCHDOG=1\n");
    ticks.tick(|| false);
    follows.tick(|| false);
    assert_eq!(manager.heard(), "", "one has neither called nor waited");
    drop(follows);
    ticks.tick(|| false);
    assert_eq!(manager.heard(), "WATCHDOG=1\n");
}

#[test]
fn a_manager_that_does_not_read_holds_up_nobody() {
    let manager = Manager::new(Some(LONG));
    let member = manager.service.join(false);
    for _ in 0..10_000 {
        member.tick(|| false);
    }
    assert!(manager.heard().len() < 10_000 * "WATCHDOG=1\n".len());
    drop(manager.socket);
    member.tick(|| false);
}

#[test]
fn what_the_manager_did_not_take_is_reported_again() {
    let manager = Manager::new(Some(LONG));
    let member = manager.service.join(false);
    // More than its queue holds.
    (0..1000).for_each(|_| member.tick(|| false));
    member.report_missing(names(&[]));
    manager.service.report_stopping();
    assert!(manager.heard().ends_with("WATCHDOG=1\n"));
    member.report_missing(names(&[]));
    assert_eq!(manager.heard(), "STOPPING=1\nREADY=1\nSTATUS=all required peers are connected\n");
    member.report_missing(names(&[]));
    assert_eq!(manager.heard(), "");
}

#[test]
fn settings_are_read_or_passed_over() {
    let own = std::process::id().to_string();
    let cases = [
        (&[][..], None),
        (&[("WATCHDOG_USEC", "500000")], Some(500)),
        (&[("WATCHDOG_USEC", "500000"), ("WATCHDOG_PID", &own)], Some(500)),
        (&[("WATCHDOG_USEC", "500000"), ("WATCHDOG_PID", "1")], None),
        (&[("WATCHDOG_USEC", "500000"), ("WATCHDOG_PID", "nonsense")], None),
        (&[("WATCHDOG_USEC", "0")], None),
        (&[("WATCHDOG_USEC", "-1")], None),
        (&[("WATCHDOG_USEC", "99999999999999999999")], None),
        (&[("WATCHDOG_USEC", "")], None),
    ];
    for (set, expected) in cases {
        let variables = |name: &str| {
            set.iter().find(|(known, _)| *known == name).map(|(_, value)| std::ffi::OsString::from(*value))
        };
        assert_eq!(watchdog(&variables), expected.map(Duration::from_millis), "{set:?}");
    }
    for address in ["", "relative", "vsock:2:1", "/nowhere/at/all", "@scl-nobody-listens"] {
        let variables = |name: &str| (name == "NOTIFY_SOCKET").then(|| address.into());
        assert!(manager(&variables).is_none(), "{address}");
    }
}

#[test]
fn an_abstract_name_is_understood() {
    use rustix::net::{AddressFamily, SocketAddrUnix, SocketType, bind, socket};
    let name = format!("scl-test-{}", std::process::id());
    let manager = socket(AddressFamily::UNIX, SocketType::DGRAM, None).unwrap();
    bind(&manager, &SocketAddrUnix::new_abstract_name(name.as_bytes()).unwrap()).unwrap();
    let variables = |asked: &str| (asked == "NOTIFY_SOCKET").then(|| format!("@{name}").into());
    Service::new(super::manager(&variables).unwrap(), watchdog(&variables)).report_stopping();
    let mut heard = [0; 64];
    let length = UnixDatagram::from(manager).recv(&mut heard).unwrap();
    assert_eq!(&heard[..length], b"STOPPING=1\n");
}
