//! A file descriptor for event loops.

use super::Component;
use crate::gate::ReadySet;
use crate::state::Driven;
use crate::stop;
use crate::sync::AbortOnDrop;
use scl_fork::ProcessOwned;
use std::io;
use std::os::fd::{AsFd, AsRawFd, BorrowedFd, RawFd};
use std::sync::{Arc, Weak};
use std::task::Waker;

/// A file descriptor that is readable while there is something to do, for `poll`, `epoll` and event loops of other
/// languages.
///
/// It is readable
/// - while one of its gates has a message or a request (level-triggered: until all were taken with `try_recv`);
/// - while a stop is requested, until [`acknowledge_stop`](Self::acknowledge_stop);
/// - after one of its [`waker`](Self::waker)s was woken, or the grace period of a stop request is over, until
///   [`acknowledge`](Self::acknowledge).
///
/// The descriptor belongs to this value: wait for it to become readable, but do not read from it or close it. While a
/// `Readiness` exists, a thread of the component does the component's I/O, so that no call has to be under way.
///
/// With a waker, any future of a gate can be awaited from an event loop: acknowledge, poll the future with the waker,
/// and, as long as it is pending, poll it again each time the descriptor becomes readable. In this order no wake-up is
/// lost: one that arrives after the acknowledgement makes the descriptor readable again.
///
/// ```
/// use rustix::event::{PollFd, PollFlags, poll};
/// use scl::plan::SystemPlan;
/// use scl::untyped::Component;
/// # fn main() -> scl::Result<()> {
/// # let transport = scl::transport::memory::Memory::new();
/// # let options = || scl::OpenOptions::new().transport(transport.clone());
///
/// let system = SystemPlan::from_json(include_str!("../../doc/rover.json"))?;
/// let mut recorder = Component::open_blocking_with(system.component("recorder")?, options())?;
/// let mut log = recorder.puller("log")?;
/// let readiness = recorder.readiness()?;
///
/// let mut sensor = Component::open_blocking_with(system.component("sensor")?, options())?;
/// let mut sends = sensor.pusher("log")?;
/// sends.send_blocking(&"any bytes".into())?;
///
/// poll(&mut [PollFd::new(&readiness, PollFlags::IN)], None)?;
/// assert_eq!(log.try_recv()?.as_deref(), Some(&b"any bytes"[..]));
/// # Ok(())
/// # }
/// ```
pub struct Readiness {
    set: Arc<ReadySet>,
    /// Watches for a stop request.
    _stop: AbortOnDrop,
    _driven: Option<ProcessOwned<Driven>>,
}

/// Wakes the event loop when the task that holds it is gone, with its runtime.
struct WakeOnDrop(Weak<ReadySet>);

impl Drop for WakeOnDrop {
    fn drop(&mut self) {
        self.0.upgrade().into_iter().for_each(|set| set.set_woken(true));
    }
}

impl Readiness {
    pub(super) fn open(component: &Component, includes: impl Fn(&str) -> bool) -> io::Result<Self> {
        let state = &component.handle.0;
        let set = ReadySet::new()?;
        state.register_calls(Arc::downgrade(&set) as _);
        let (stopping, ended) = (Arc::downgrade(&set), WakeOnDrop(Arc::downgrade(&set)));
        let stop = state.spawn(async move {
            stop::STOP.requested().await;
            stopping.upgrade().into_iter().for_each(|set| set.request_stop());
            // If the program handles the request, it acknowledges it, so wake it once more when its grace period is
            // over and waiting calls end.
            if !stop::gates_stopped() {
                stop::STOP.until_gates_stopped().await;
                stopping.upgrade().into_iter().for_each(|set| set.set_woken(true));
            }
            let _ended = ended;
            std::future::pending::<()>().await;
        });
        for watch in component.watches.iter().filter(|watch| includes(watch.spec.name)) {
            watch.report_to(Arc::downgrade(&set));
        }
        Ok(Self { set, _stop: stop, _driven: state.drive_always().map(ProcessOwned::new) })
    }

    /// Returns a waker that makes the descriptor readable. All wakers of a `Readiness` are the same, so after one
    /// wake-up, any future that is polled with one of them may be ready.
    pub fn waker(&self) -> Waker {
        Waker::from(Arc::clone(&self.set))
    }

    /// Acknowledges wake-ups: the descriptor is no longer readable, unless a gate has a message or a request, or a stop
    /// is requested. Call it before polling futures again.
    pub fn acknowledge(&self) {
        self.set.set_woken(false);
    }

    /// Acknowledges a stop request, for a program that continues after it.
    pub fn acknowledge_stop(&self) {
        if stop::was_requested() {
            self.set.acknowledge_stop();
        }
    }
}

impl AsFd for Readiness {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.set.descriptor()
    }
}

impl AsRawFd for Readiness {
    fn as_raw_fd(&self) -> RawFd {
        self.as_fd().as_raw_fd()
    }
}

impl std::fmt::Debug for Readiness {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Readiness").field(&self.as_raw_fd()).finish()
    }
}

#[cfg(test)]
#[cfg(feature = "memory")]
mod tests {
    use super::*;
    use crate::OpenOptions;
    use crate::plan::SystemPlan;
    use crate::transport::memory::Memory;

    #[test]
    fn a_forked_child_leaves_the_runtime_to_its_parent() {
        let system = SystemPlan::from_json(include_str!("../../doc/rover.json")).unwrap();
        let options = OpenOptions::new().transport(Memory::new());
        let recorder = Component::open_blocking_with(system.component("recorder").unwrap(), options).unwrap();
        let calls_may_wait = || recorder.handle.0.direct_wait().is_some();
        let mut readiness = recorder.readiness().unwrap();
        assert!(!calls_may_wait());
        readiness._driven.as_mut().unwrap().inherit();
        drop(readiness);
        assert!(!calls_may_wait(), "the child tells the thread that drives the runtime");
    }
}
