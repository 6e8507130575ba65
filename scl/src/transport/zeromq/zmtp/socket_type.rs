//! The types of ZeroMQ sockets.

scl_text::words! {
    /// The socket types as which SCL's ends appear to their peers.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(in crate::transport::zeromq) enum SocketType {
        /// A publishing end.
        XPub = "XPUB",
        /// A subscribing end.
        Sub = "SUB",
        /// A pushing end.
        Push = "PUSH",
        /// A pulling end.
        Pull = "PULL",
        /// A requesting end.
        Dealer = "DEALER",
        /// A replying end.
        Router = "ROUTER",
    }
}

impl SocketType {
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
