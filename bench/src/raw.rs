//! Sockets without SCL: their addresses, and sockets of the `zeromq` crate.

use std::path::{Path, PathBuf};
use zeromq::{PubSocket, Socket, SubSocket, XPubSocket};

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

    /// A PUB socket of `zeromq`, which unlike XPUB does not wait for a subscriber that does not receive.
    pub(crate) async fn bind_pub(&self, socket: &str) -> scl::Result<PubSocket> {
        let mut publisher = PubSocket::new();
        publisher.bind(&self.endpoint(socket)).await?;
        Ok(publisher)
    }

    /// An XPUB socket of `zeromq`, which shows when a subscriber has connected.
    pub(crate) async fn bind_xpub(&self, socket: &str) -> scl::Result<XPubSocket> {
        let mut xpub = XPubSocket::new();
        xpub.bind(&self.endpoint(socket)).await?;
        Ok(xpub)
    }

    /// A SUB socket of `zeromq` that subscribes to everything.
    pub(crate) async fn connect_sub(&self, socket: &str) -> scl::Result<SubSocket> {
        let mut sub = SubSocket::new();
        sub.connect(&self.endpoint(socket)).await?;
        sub.subscribe("").await?;
        Ok(sub)
    }
}
