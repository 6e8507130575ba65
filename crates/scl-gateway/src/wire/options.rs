//! Options of the wire: this host, its neighbours, and who may do what.

use std::collections::BTreeMap;

use crate::keys::HostFiles;
use crate::route::Route;

/// How this host's gateway reaches the others.
#[derive(Debug, Clone)]
pub struct WireOptions {
    /// Name of the system. Gateways of other systems are refused.
    pub system: String,
    /// Name of this host.
    pub host: String,
    /// `address:port` to listen on, IPv6 in brackets; port 0 takes any free one. `None`: only connect to others.
    pub listen: Option<String>,
    /// The other hosts with which this one shares routes.
    pub peers: Vec<Peer>,
    /// Certificates. Without them only loopback addresses are accepted.
    pub tls: Option<HostFiles>,
    /// Accept any address without TLS. Everybody on the network can then listen and send.
    pub insecure: bool,
    /// All routes of this host. The access list is derived from them: a host, identified by the common name of its
    /// certificate, which is the host's name, may send, announce and answer only what the routes allow. Without TLS no
    /// host is authenticated, so every host on a loopback connection may do what any host may.
    pub routes: Vec<Route>,
    /// The host of each component of the system. A host that announces another's component is refused.
    pub components: BTreeMap<String, String>,
}

/// Another host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Peer {
    pub host: String,
    /// `address:port` where its gateway listens. `None`: it connects to this host. Of two hosts that both listen, the
    /// one whose name is smaller connects.
    pub address: Option<String>,
}
