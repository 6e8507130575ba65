//! The types of ZeroMQ sockets.

/// The socket types as which SCL's ends appear to their peers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::transport::zeromq) enum SocketType {
    /// A publishing end.
    XPub,
    /// A subscribing end.
    Sub,
    /// A pushing end.
    Push,
    /// A pulling end.
    Pull,
    /// A requesting end.
    Dealer,
    /// A replying end.
    Router,
}

impl SocketType {
    pub(super) const ALL: [Self; 6] = [Self::XPub, Self::Sub, Self::Push, Self::Pull, Self::Dealer, Self::Router];

    pub(in crate::transport::zeromq) fn name(self) -> &'static str {
        match self {
            Self::XPub => "XPUB",
            Self::Sub => "SUB",
            Self::Push => "PUSH",
            Self::Pull => "PULL",
            Self::Dealer => "DEALER",
            Self::Router => "ROUTER",
        }
    }

    pub(super) fn peers(self) -> &'static [&'static [u8]] {
        match self {
            Self::XPub => &[b"SUB", b"XSUB"],
            Self::Sub => &[b"PUB", b"XPUB"],
            Self::Push => &[b"PULL"],
            Self::Pull => &[b"PUSH"],
            Self::Dealer => &[b"REP", b"ROUTER"],
            Self::Router => &[b"REQ", b"DEALER"],
        }
    }
}
