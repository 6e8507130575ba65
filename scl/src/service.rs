//! Reports the state of this process to a service manager, systemd or `scl run`, as `sd_notify(3)` describes.
//!
//! The manager names a socket in `NOTIFY_SOCKET`. Each component of the process is a member; the process is ready once
//! all members have been ready, and alive while all are alive. `docs/service.md` says what is sent when.
//!
//! The datagrams are sent without waiting: a manager that does not read must not hold up a control loop, which rules
//! out libraries whose socket may block.

mod member;
mod socket;
#[cfg(test)]
mod tests;

pub(crate) use member::{Member, Waiting};

use crate::environment::Variables;
use crate::sync::lock;
use socket::Socket;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, Weak};
use std::time::{Duration, Instant};

static SERVICE: OnceLock<Option<Arc<Service>>> = OnceLock::new();

/// From now on the components that this process opens are reported to the service manager, if there is one. Further
/// calls do nothing.
pub(crate) fn start(variables: Variables<'_>) {
    SERVICE.get_or_init(|| manager(variables).map(|socket| Arc::new(Service::new(socket, watchdog(variables)))));
}

/// Adds a component to those reported. Returns `None` if there is no service manager. `follows_calls`: see [`Member`].
pub(crate) fn join(follows_calls: impl FnOnce() -> bool) -> Option<Arc<Member>> {
    Some(SERVICE.get()?.as_ref()?.join(follows_calls()))
}

/// Reports that a stop was requested.
pub(crate) fn stopping() {
    if let Some(Some(service)) = SERVICE.get() {
        service.report_stopping();
    }
}

/// Sends the service manager one notification, if there is a manager.
pub(crate) fn tell(variables: Variables<'_>, text: &str) {
    if let Some(socket) = manager(variables) {
        socket.send(text);
    }
}

/// The connection to the service manager.
pub(crate) struct Service {
    socket: Socket,
    /// The time within which the manager expects a report that the process is alive, if it wants any.
    watchdog: Option<Duration>,
    reported: Mutex<Reported>,
    /// Whether the manager did not take the last notification of a change.
    untold: AtomicBool,
}

#[derive(Default)]
struct Reported {
    members: Vec<Weak<Member>>,
    /// Whether the manager knows that the process is ready. This, `status` and `stopping` change only when the manager
    /// takes the notification; until then it is sent again.
    ready: bool,
    status: String,
    stopping: bool,
    alive: Option<Instant>,
    /// Whether a stop was requested.
    stops: bool,
}

impl Service {
    fn new(socket: Socket, watchdog: Option<Duration>) -> Self {
        Self { socket, watchdog, reported: Mutex::default(), untold: AtomicBool::new(false) }
    }

    fn join(self: &Arc<Self>, follows_calls: bool) -> Arc<Member> {
        let member = Arc::new(Member::new(Arc::clone(self), follows_calls));
        lock(&self.reported).members.push(Arc::downgrade(&member));
        member
    }

    fn report_stopping(&self) {
        lock(&self.reported).stops = true;
        self.report_changes();
    }

    /// Reports a stop request, changes in the readiness of the members, and whatever the manager did not take before.
    fn report_changes(&self) {
        let mut reported = lock(&self.reported);
        let members = reported.members();
        let stopping = reported.stops;
        let mut text = String::new();
        if stopping && !reported.stopping {
            text.push_str("STOPPING=1\n");
        }
        let ready = reported.ready || (!members.is_empty() && members.iter().all(|member| member.was_ready()));
        if ready && !reported.ready {
            text.push_str("READY=1\n");
        }
        let status = if members.is_empty() { reported.status.clone() } else { status(&members) };
        if reported.status != status {
            text.push_str(&format!("STATUS={status}\n"));
        }
        let is_told = text.is_empty() || self.socket.send(&text);
        if is_told {
            (reported.ready, reported.status, reported.stopping) = (ready, status, stopping);
        }
        self.untold.store(!is_told, Ordering::Relaxed);
    }

    /// Reports that the process is alive, if all members have been alive since the last such report, and that was at
    /// least `not_before` ago.
    fn report_alive(&self, not_before: Duration) {
        let mut reported = lock(&self.reported);
        let now = Instant::now();
        let is_due = reported.alive.is_none_or(|last| now.duration_since(last) >= not_before);
        let members = reported.members();
        if is_due && members.iter().all(|member| member.was_alive()) {
            members.iter().for_each(|member| member.forget_life());
            reported.alive = Some(now);
            self.socket.send("WATCHDOG=1\n");
        }
    }
}

/// Connects to the socket of the service manager. Returns `None` if there is no manager, or it cannot be reached.
fn manager(variables: Variables<'_>) -> Option<Socket> {
    let address = variables("NOTIFY_SOCKET").filter(|address| !address.is_empty())?;
    let connected = Socket::connect(&address);
    let warn = |error: &io::Error| {
        tracing::warn!(?address, %error, "cannot reach the service manager that `NOTIFY_SOCKET` names");
    };
    connected.inspect_err(warn).ok()
}

impl Reported {
    fn members(&mut self) -> Vec<Arc<Member>> {
        self.members.retain(|member| member.strong_count() > 0);
        self.members.iter().filter_map(Weak::upgrade).collect()
    }
}

/// Maximum number of peers that a status names.
const NAMED: usize = 8;

fn status(members: &[Arc<Member>]) -> String {
    let missing: Vec<String> = members.iter().flat_map(|member| member.missing()).collect();
    if missing.is_empty() {
        return "all required peers are connected".to_owned();
    }
    let named = missing.iter().take(NAMED).map(|peer| format!("`{}`", peer.escape_debug()));
    let named = named.collect::<Vec<_>>().join(", ");
    match missing.len().saturating_sub(NAMED) {
        0 => format!("waiting for {named}"),
        others => format!("waiting for {named} and {others} more"),
    }
}

/// Reads `WATCHDOG_USEC` and `WATCHDOG_PID`.
fn watchdog(variables: Variables<'_>) -> Option<Duration> {
    let number = |name| variables(name)?.to_str()?.parse::<u64>().ok();
    let is_ours = variables("WATCHDOG_PID").is_none() || number("WATCHDOG_PID") == Some(std::process::id().into());
    let micros = number("WATCHDOG_USEC").filter(|&micros| micros > 0 && is_ours)?;
    Some(Duration::from_micros(micros))
}
