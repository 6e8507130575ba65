//! Gates: the typed ends of connections, as the fields of a component.

mod call_wakers;
mod catch_up;
mod connection;
mod decoder;
mod due;
mod encoding;
mod exchange;
mod fanout;
mod foreign;
mod foreign_texts;
mod inbox;
mod incoming;
mod io_waker;
mod latch;
mod links;
mod loaned;
mod missed;
mod outgoing;
mod publisher;
mod puller;
mod pusher;
mod queue;
mod ready_set;
mod receiving_gate;
mod replier;
mod reply_end;
mod requester;
mod sending_gate;
mod stats;
mod subscriber;
mod tap;
mod undecodable;
#[cfg(feature = "raw")]
mod view;
mod watch;

pub(crate) use connection::Connection;
pub(crate) use incoming::Incoming;
pub use loaned::Loaned;
pub(crate) use outgoing::Outgoing;
pub use publisher::Pub;
pub use puller::Pull;
pub use pusher::Push;
pub(crate) use ready_set::ReadySet;
pub use replier::{Rep, Request};
pub use requester::Req;
pub use stats::{GateStats, PeerStats};
pub use subscriber::Sub;
pub(crate) use tap::GateTap;
#[cfg(feature = "raw")]
pub use view::View;
pub(crate) use watch::Watch;

use crate::error::{PeerName, RecvError};
use crate::spec::{ConnectionSpec, GateSpec};
use std::task::{Context, Poll};

/// What the gates of all kinds have in common. Only SCL's gates implement it.
pub trait AnyGate: sealed::Sealed {
    /// What the topology says about the gate.
    fn spec(&self) -> &'static GateSpec;

    /// Returns a watch that reports the required peers that are not connected, for as long as the gate exists. Gates
    /// that listen for any number of peers (`rep`, `pull`) have none.
    #[doc(hidden)]
    fn watch(&self) -> Watch;
}

/// A gate that receives: `sub`, `pull` or `rep`. Only SCL's gates implement it.
pub trait ReceivingGate: AnyGate {
    /// Ready when the gate has a message or a request, which `try_recv` then returns. It takes none, so it may be
    /// called any number of times, also to wait for several gates at once.
    ///
    /// ```no_run
    /// use scl::ReceivingGate;
    /// # scl::topology!("doc/rover.yaml");
    /// # async fn wait(mut controller: Controller) -> scl::Result<()> {
    /// std::future::poll_fn(|cx| controller.sensor.poll_ready(cx)).await?;
    /// let measurement = controller.sensor.try_recv()?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`RecvError::Blocking`] if the gate cannot be used any more, also after a stop request.
    ///
    /// # Cancel safety
    /// It may be called once and never again. Each call replaces the waker of the one before.
    fn poll_ready(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), RecvError>>;
}

/// Returns the peer, the length and the peer's `max_size` if a message of this length exceeds that limit.
fn exceeded(connection: Option<&'static ConnectionSpec>, length: usize) -> Option<(PeerName, u64, u64)> {
    let connection = connection.filter(|connection| length as u64 > connection.max_size)?;
    Some((PeerName::of(connection), length as u64, connection.max_size))
}

mod sealed {
    pub trait Sealed {}
}
