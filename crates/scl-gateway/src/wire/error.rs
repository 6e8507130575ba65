//! Why the wire could not be opened.

/// Error of [`Wire::open`](super::Wire::open).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WireError {
    #[error(
        "`{address}` is not a loopback address, and without certificates everybody on the network could listen and send\n\
         help: run `scl gateway keys`, or allow it in a network that you trust completely"
    )]
    NoTls { address: String },
    #[error("`{address}` is not an address of the form `host:port`")]
    Address { address: String },
    #[error("cannot use the certificates of host `{host}`: {reason}")]
    Certificates { host: String, reason: String },
    #[error("cannot listen on `{address}`: {reason}")]
    Listen { address: String, reason: String },
    #[error("cannot start the gateway of host `{host}`: {reason}")]
    Start { host: String, reason: String },
}
