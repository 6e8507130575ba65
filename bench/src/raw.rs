//! Sockets without SCL: their addresses, and sockets of the `zeromq` crate.

use std::path::{Path, PathBuf};
use zeromq::{Socket, SubSocket};

/// The paths of the raw sockets of one variant of a benchmark.
#[derive(Debug, Clone)]
pub(crate) struct SocketPaths(PathBuf);

impl SocketPaths {
    /// Paths that start with `name`, in a benchmark's scratch folder.
    pub(crate) fn new(folder: &str, name: &str) -> Self {
        Self(Path::new(folder).join("raw").join(name))
    }

    /// The path of one of the variant's sockets.
    pub(crate) fn path(&self, socket: &str) -> PathBuf {
        self.0.with_extension(socket)
    }

    /// [`path`](Self::path) as a ZeroMQ endpoint.
    pub(crate) fn endpoint(&self, socket: &str) -> String {
        format!("ipc://{}", self.path(socket).display())
    }

    /// Opens a socket of `zeromq` that listens. PUB, unlike XPUB, does not wait for a stalled subscriber; XPUB shows
    /// when a subscriber has connected.
    pub(crate) async fn bind<S: Socket>(&self, socket: &str) -> scl::Result<S> {
        let mut bound = S::new();
        bound.bind(&self.endpoint(socket)).await?;
        Ok(bound)
    }

    /// Opens a socket of `zeromq` that connects.
    pub(crate) async fn connect<S: Socket>(&self, socket: &str) -> scl::Result<S> {
        let mut connected = S::new();
        connected.connect(&self.endpoint(socket)).await?;
        Ok(connected)
    }

    /// Opens a SUB socket of `zeromq` that subscribes to everything.
    pub(crate) async fn connect_sub(&self, socket: &str) -> scl::Result<SubSocket> {
        let mut sub: SubSocket = self.connect(socket).await?;
        sub.subscribe("").await?;
        Ok(sub)
    }
}
