//! The six kinds of gate, and what a full queue does.

use scl_text::words;

words! {
    /// What a gate does.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum GateKind {
        /// Sends to any number of subscribers.
        Pub = "pub",
        /// Receives from one or several publishers.
        Sub = "sub",
        /// Asks one replier.
        Req = "req",
        /// Answers any number of requesters.
        Rep = "rep",
        /// Hands work to a puller.
        Push = "push",
        /// Takes work from any number of pushers.
        Pull = "pull",
    }
}

impl GateKind {
    /// What a gate of this kind does, for its documentation: `publishes rover.Measurement to controller.sensor`.
    pub fn sentence(self, message: &str, peers: &str) -> String {
        match self {
            GateKind::Pub => format!("publishes {message} to {peers}"),
            GateKind::Sub => format!("subscribes to {message} from {peers}"),
            GateKind::Req => format!("requests {message} from {peers}"),
            GateKind::Rep => format!("replies {message} to {peers}"),
            GateKind::Push => format!("pushes {message} to {peers}"),
            GateKind::Pull => format!("pulls {message} from {peers}"),
        }
    }

    /// Returns true if messages start here: `pub`, `push` and `req`.
    pub const fn is_source(self) -> bool {
        matches!(self, GateKind::Pub | GateKind::Push | GateKind::Req)
    }

    /// The kind at the other end of a connection.
    pub const fn opposite(self) -> GateKind {
        match self {
            GateKind::Pub => GateKind::Sub,
            GateKind::Sub => GateKind::Pub,
            GateKind::Req => GateKind::Rep,
            GateKind::Rep => GateKind::Req,
            GateKind::Push => GateKind::Pull,
            GateKind::Pull => GateKind::Push,
        }
    }

    /// Returns true if the gate listens and its peers connect to it: `pub`, `rep` and `pull`.
    pub const fn listens(self) -> bool {
        matches!(self, GateKind::Pub | GateKind::Rep | GateKind::Pull)
    }

    /// Returns true if the gate listens at one endpoint for all its peers: `rep` and `pull`.
    pub const fn shares_endpoint(self) -> bool {
        matches!(self, GateKind::Rep | GateKind::Pull)
    }

    /// Returns true if messages are answered: `req` and `rep`.
    pub const fn exchanges(self) -> bool {
        matches!(self, GateKind::Req | GateKind::Rep)
    }
}

words! {
    /// What a receiving call does with a message that its codec cannot read.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum Undecodable {
        /// The message is counted, logged and skipped; the call goes on with the next one.
        #[default]
        Skip = "skip",
        /// The call fails.
        Fail = "fail",
    }
}

words! {
    /// What a full queue does.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum WhenFull {
        /// The oldest waiting message is dropped.
        #[default]
        DropOldest = "drop_oldest",
        /// The new message is dropped.
        DropNewest = "drop_newest",
        /// The sender waits, if it allows that.
        Wait = "wait",
    }
}
