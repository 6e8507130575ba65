//! Where panels connect.

use foxglove::{Context, WebSocketServer, WebSocketServerHandle};
use scl_terminal::Problem;
use std::net::SocketAddr;
use std::sync::Arc;

/// The address of the server, and what its channels belong to.
pub(crate) struct Listen {
    pub(crate) address: SocketAddr,
    /// Of its own, so that nothing else is sent to panels.
    pub(crate) context: Arc<Context>,
}

impl Listen {
    pub(crate) fn new(address: SocketAddr) -> Self {
        Self { address, context: Context::new() }
    }

    /// A server to be described further.
    pub(crate) fn server(&self) -> WebSocketServer {
        WebSocketServer::new().context(&self.context).bind(self.address.ip().to_string(), self.address.port())
    }

    /// Starts the server.
    ///
    /// # Errors
    /// It cannot listen at the address.
    pub(crate) async fn start(&self, server: WebSocketServer) -> Result<WebSocketServerHandle, Problem> {
        server.start().await.map_err(|error| {
            let problem = Problem::new(format!("cannot listen at {}: {error}", self.address));
            problem.help("choose another port with `--port`, or 0 for any that is free")
        })
    }
}
