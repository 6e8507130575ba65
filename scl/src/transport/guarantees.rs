//! What a transport promises beyond moving messages in order.

use std::fmt;

/// A promise that some gates need from a transport, beyond delivering the messages of a connection complete and in
/// order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Guarantee {
    /// [`Link::unacknowledged`](super::Link::unacknowledged) counts messages until the receiving program has taken
    /// them, and [`Link::request_acknowledgement`](super::Link::request_acknowledgement) asks the peer to acknowledge
    /// the rest. Without it, a flush ends when messages are written, and a peer's counts are those of messages handed
    /// to the transport.
    Acknowledgement,
    /// A link refuses messages for a receiver that does not take them, instead of dropping any, and the receiving end
    /// knows whether its sender relies on that ([`Receiver::is_lossless`](super::Receiver::is_lossless)).
    Waiting,
    /// A receiving end finds out whether its sender has a newer message
    /// ([`Receiver::poll_caught_up`](super::Receiver::poll_caught_up)).
    Freshness,
    /// Requests and replies.
    Requests,
}

impl Guarantee {
    /// All guarantees.
    pub const ALL: [Self; 4] = [Self::Acknowledgement, Self::Waiting, Self::Freshness, Self::Requests];
}

/// Describes what the guarantee gives a gate, for error messages.
impl fmt::Display for Guarantee {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Acknowledgement => "acknowledgements of the messages that were taken",
            Self::Waiting => "senders that wait instead of dropping messages",
            Self::Freshness => "the newest message, also after a pause",
            Self::Requests => "requests and replies",
        })
    }
}

/// A set of [`Guarantee`]s.
///
/// ```
/// use scl::transport::{Guarantee, Guarantees};
///
/// const ONE_WAY: Guarantees = Guarantees::ALL.without(Guarantee::Requests);
/// assert!(ONE_WAY.contains(Guarantee::Freshness) && !ONE_WAY.contains(Guarantee::Requests));
/// assert_eq!(ONE_WAY.with(Guarantee::Requests), Guarantees::ALL);
/// ```
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Guarantees(u8);

impl Guarantees {
    /// No guarantees.
    pub const NONE: Self = Self(0);
    /// All guarantees.
    pub const ALL: Self = Self::NONE
        .with(Guarantee::Acknowledgement)
        .with(Guarantee::Waiting)
        .with(Guarantee::Freshness)
        .with(Guarantee::Requests);

    /// Returns this set with `guarantee` added.
    #[must_use]
    pub const fn with(self, guarantee: Guarantee) -> Self {
        Self(self.0 | 1 << guarantee as u8)
    }

    /// Returns this set without `guarantee`.
    #[must_use]
    pub const fn without(self, guarantee: Guarantee) -> Self {
        Self(self.0 & !(1 << guarantee as u8))
    }

    /// Returns true if the set contains `guarantee`.
    pub const fn contains(self, guarantee: Guarantee) -> bool {
        self.0 & (1 << guarantee as u8) != 0
    }
}

impl FromIterator<Guarantee> for Guarantees {
    fn from_iter<I: IntoIterator<Item = Guarantee>>(guarantees: I) -> Self {
        guarantees.into_iter().fold(Self::NONE, Self::with)
    }
}

impl fmt::Debug for Guarantees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(Guarantee::ALL.into_iter().filter(|&guarantee| self.contains(guarantee))).finish()
    }
}
