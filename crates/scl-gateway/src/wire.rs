//! The wire: everything between two gateways. It knows routes and bytes, but neither components' sockets nor files of
//! the runtime folder.
//!
//! Every handle ([`WireSender`], [`WireReceiver`], [`WireRequester`], [`WireReplier`], [`Announced`]) is `Send` and
//! belongs to one task. Nothing here blocks: commands go through a channel to a plain thread, which makes all calls of
//! the network library, and events come back through one queue per handle, which wakes the task that polled last. The
//! `poll_*` functions set timers and so need a tokio runtime with time enabled.

mod access;
mod announcement;
mod command;
mod config;
mod connection_log;
mod envelope;
mod error;
mod header;
mod keys;
mod lane;
mod mailbox;
mod neighbour;
mod options;
mod presence;
mod receiver;
mod replier;
mod requester;
mod sender;
mod session;
mod stream;
mod token;
mod user_timeout;

use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::Arc;
use std::task::{Context, Poll};

use bytes::Bytes;
use tokio::sync::oneshot;

pub use self::announcement::Announced;
use self::command::{Command, Commands, Declared};
pub use self::connection_log::ConnectionLog;
pub use self::error::WireError;
use self::mailbox::Mailbox;
pub use self::neighbour::Neighbour;
pub use self::options::{Peer, WireOptions};
use self::presence::Presence;
pub use self::receiver::WireReceiver;
pub use self::replier::{ReplierEvent, WireReplier};
pub use self::requester::{RequesterEvent, WireRequester};
pub use self::sender::WireSender;
pub use self::stream::{ReceiverEvent, SenderEvent};
use crate::route::Route;

/// Maximum number of unacknowledged messages of one route; less if the receiving gate's queue is smaller.
pub const WINDOW_MESSAGES: u32 = 64;

/// Maximum number of unacknowledged bytes of one route. A larger message is sent alone.
pub const WINDOW_BYTES: u64 = 256 * 1024;

/// The part of the wire that every handle needs.
#[derive(Debug, Clone)]
struct Link {
    options: Arc<WireOptions>,
    commands: Commands,
    /// The table of connected gateways.
    presence: Presence,
    /// Identifies this run of the gateway.
    instance: String,
}

/// This host's connection to the gateways of the other hosts. Dropping it closes it in the background.
#[derive(Debug)]
pub struct Wire {
    link: Link,
    neighbours: Arc<Mailbox<Neighbour>>,
}

impl Wire {
    /// Starts listening and connecting. Returns as soon as the listener is bound, whether or not other gateways run.
    ///
    /// # Errors
    ///
    /// Fails if an address is malformed, if there is no TLS for an address that is not loopback, if a certificate file
    /// cannot be used, or if the address is taken. A second gateway of the same host, here or elsewhere, is detected
    /// when both are connected to one network: see [`Neighbour::Refused`].
    pub async fn open(options: WireOptions) -> Result<Wire, WireError> {
        let options = Arc::new(options);
        let failed = |reason: String| WireError::Start { host: options.host.clone(), reason };
        let config = config::config(&options)?;
        let config = zenoh::Config::from_json5(&config.to_string()).map_err(|error| failed(error.to_string()))?;
        let instance = format!("{}-{:x}", std::process::id(), random());
        let (commands, received) = Commands::new();
        let neighbours = Arc::new(Mailbox::new(u64::MAX));
        let presence = Presence::new(&options, &instance, &commands, &neighbours);
        let link = Link { options: Arc::clone(&options), commands, presence, instance };
        let setup = session::Setup { config, link: link.clone(), received, neighbours: Arc::clone(&neighbours) };
        let (ready, started) = oneshot::channel();
        std::thread::Builder::new()
            .name("scl-wire".to_owned())
            .spawn(move || session::run(setup, ready))
            .map_err(|error| failed(error.to_string()))?;
        started.await.map_err(|_| failed("its thread ended".to_owned()))??;
        Ok(Wire { link, neighbours })
    }

    pub(crate) fn options(&self) -> &WireOptions {
        &self.link.options
    }

    /// Returns the end at which messages leave this host, which must be `route.from.host`. At most one may exist per
    /// route.
    pub fn sender(&self, route: &Route) -> WireSender {
        WireSender::new(&self.link, route)
    }

    /// Returns the end at which messages arrive at this host, which must be `route.to.host`. At most one may exist per
    /// route.
    pub fn receiver(&self, route: &Route) -> WireReceiver {
        WireReceiver::new(&self.link, route)
    }

    /// Returns the end at which requests leave this host: the `req` gates are here, the `rep` gate is remote.
    pub fn requester(&self, route: &Route) -> WireRequester {
        WireRequester::new(&self.link, route)
    }

    /// Returns the end at which requests arrive at this host: the `rep` gate is here.
    pub fn replier(&self, route: &Route) -> WireReplier {
        WireReplier::new(&self.link, route)
    }

    /// Announces to the other hosts that `component` runs here, until the result is dropped. `content` is its
    /// announcement and schema, up to a few MiB, which each neighbour receives in [`Neighbour::Started`].
    pub fn announce(&self, component: &str, content: Bytes) -> Announced {
        let WireOptions { system, host, .. } = self.options();
        let key = keys::component(system, component, host, &self.link.instance, random());
        Announced { _declared: Declared::new(&self.link.commands, |id| Command::Announce { id, key, content }) }
    }

    /// Polls for the next event: what the other hosts run, and what is wrong with them. Never ends.
    pub fn poll_neighbour(&self, cx: &mut Context<'_>) -> Poll<Neighbour> {
        self.neighbours.poll(cx)
    }

    /// Withdraws everything and closes all connections. Does not wait for messages in flight.
    pub async fn close(self) {
        let (done, closed) = oneshot::channel();
        self.link.commands.send(Command::Close { done: Some(done) });
        let _ = closed.await;
    }
}

impl Drop for Wire {
    fn drop(&mut self) {
        self.link.commands.send(Command::Close { done: None });
    }
}

/// A unique number; not cryptographically random.
fn random() -> u64 {
    RandomState::new().build_hasher().finish()
}
