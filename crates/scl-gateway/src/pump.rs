//! Running routes: each is one task that connects an end in the runtime folder with an end of the wire.
//!
//! | route | where messages or requests leave | where they arrive |
//! |---|---|---|
//! | `pub` to `sub` | [`sending`]: subscribes in place of the subscriber | [`receiving`]: publishes in place of the publisher |
//! | `push` to `pull` | [`sending`]: pulls in place of the puller | [`receiving`]: pushes |
//! | `req` to `rep` | [`requesting`]: replies in place of the replier | [`replying`]: requests |
//!
//! A message is acknowledged to the component that sent it when the component at the far end has taken it, so queues,
//! waiting and flushes work as if the two components were connected directly. While the far end is closed, so is the
//! near one, and messages wait in the sending component.
//!
//! States of the end in the runtime folder, for a route on which messages leave this host:
//!
//! ```text
//!          the far end is matched and shown here, the publisher runs
//!   closed ───────────────────────────────────────────────────────────▶ open    takes what fits into the window
//!     ▲                                                                  │
//!     │ everything on its way          unmatched, another far component, │
//!     │ is taken, or 1 s is over       a new receiver, the gateway ends  ▼
//!     └──────────────────────────────────────────────────────────── finishing   takes everything
//! ```
//!
//! and for a route on which messages arrive:
//!
//! ```text
//!          the far end is matched, or messages are left       the component connects: an epoch begins
//!   closed ─────────────────────────────────────────▶ waiting ───────────────────────────────▶ connected
//!     ▲                                               │     ▲                                    │  │
//!     │ nothing is left and the far end is gone,      │     └────────────────────────────────────┘  │
//!     │ or 1 s after it has gone                      │       it disconnects: the epoch ends        │
//!     └───────────────────────────────────────────────┴─────────────────────────────────────────────┘
//! ```
//!
//! Each message is counted once: sent = settled + unacknowledged where messages leave, arrived = handed over + queued
//! where they arrive, and what is acknowledged is never more than what was sent.

mod counts;
mod local_end;
mod receiving;
mod replying;
mod requesting;
mod sending;

pub use counts::Counts;
pub(crate) use receiving::Receiving;
pub(crate) use replying::Replying;
pub(crate) use requesting::Requesting;
pub(crate) use sending::Sending;

use crate::route::Route;
use crate::slot::{Held, View};
use crate::wire::Announced;
use local_end::Attempts;
use scl::bridge::Mirror;
use scl::transport::zeromq::ZeroMq;
use std::future::{pending, poll_fn};
use std::sync::Arc;
use std::task::{Context, Poll};
use tokio::sync::watch;

/// A route and the components at its two ends.
pub(crate) struct Ends {
    pub(crate) route: Route,
    /// The mirror of the far component, for which the local end is opened; `None` if any component may connect.
    pub(crate) mirror: Option<View<Mirror>>,
    /// The component here; `None` if any component may connect.
    pub(crate) component: Option<View<Announced>>,
    pub(crate) transport: Arc<ZeroMq>,
    pub(crate) counts: Arc<Counts>,
}

/// A running route: its end of the wire, `W`, and the state of its end in the runtime folder, `S`.
pub(crate) struct Pump<W, S> {
    route: Route,
    wire: W,
    mirror: Option<View<Mirror>>,
    component: Option<View<Announced>>,
    transport: Arc<ZeroMq>,
    counts: Arc<Counts>,
    /// Whether the far end of the wire is open.
    matched: bool,
    attempts: Attempts,
    /// Whether the gateway is stopping.
    stopping: bool,
    state: S,
}

/// How a pump carries messages or requests.
pub(crate) trait Carry {
    /// Makes as much progress as possible. Ready when the gateway is stopping and nothing is left to do.
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()>;

    /// Called when the component here has started or stopped.
    fn component_changed(&mut self) {}
}

impl<W, S: Default> Pump<W, S>
where
    Self: Carry,
{
    pub(crate) fn new(ends: Ends, wire: W) -> Self {
        let Ends { route, mirror, component, transport, counts } = ends;
        let (matched, attempts, stopping, state) = (false, Attempts::default(), false, S::default());
        Self { route, wire, mirror, component, transport, counts, matched, attempts, stopping, state }
    }

    /// Runs until the gateway stops. Then it still takes messages in flight from components here and hands over
    /// messages that have arrived for them; messages that the far side does not acknowledge soon stay unacknowledged
    /// here, too.
    pub(crate) async fn run(mut self, mut stop: watch::Receiver<bool>) {
        let (mut mirror, mut component) = (self.mirror.clone(), self.component.clone());
        loop {
            let alive = tokio::select! {
                changed = changed_if_any(&mut mirror) => changed,
                changed = changed_if_any(&mut component) => {
                    self.component_changed();
                    changed
                }
                stopping = stop.changed() => {
                    self.stopping = true;
                    stopping.is_ok()
                }
                () = poll_fn(|cx| self.poll(cx)) => false,
            };
            if !alive {
                return;
            }
        }
    }
}

/// Waits until a component has started or ended; forever without a view. Returns false when the gateway ends.
async fn changed_if_any<T>(view: &mut Option<View<T>>) -> bool {
    match view {
        Some(view) => view.changed().await.is_ok(),
        None => pending().await,
    }
}

/// Returns the current run or mirror of the component, if it is running.
fn running<T>(view: &Option<View<T>>) -> Option<Held<T>> {
    view.as_ref()?.borrow().clone()
}
