//! The six kinds of gate, and what a full queue does.

/// What a gate does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GateKind {
    /// Sends to any number of subscribers.
    Pub,
    /// Receives from one or several publishers.
    Sub,
    /// Asks one replier.
    Req,
    /// Answers any number of requesters.
    Rep,
    /// Hands work to a puller.
    Push,
    /// Takes work from any number of pushers.
    Pull,
}

impl GateKind {
    /// All kinds, in the order in which messages list them.
    pub const ALL: [GateKind; 6] =
        [GateKind::Pub, GateKind::Sub, GateKind::Req, GateKind::Rep, GateKind::Push, GateKind::Pull];

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

    /// The word in topology files and plans.
    pub const fn word(self) -> &'static str {
        match self {
            GateKind::Pub => "pub",
            GateKind::Sub => "sub",
            GateKind::Req => "req",
            GateKind::Rep => "rep",
            GateKind::Push => "push",
            GateKind::Pull => "pull",
        }
    }

    /// The kind with this word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.word() == word)
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

/// What a receiving call does with a message that its codec cannot read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Undecodable {
    /// The message is counted, logged and skipped; the call goes on with the next one.
    #[default]
    Skip,
    /// The call fails.
    Fail,
}

impl Undecodable {
    /// All of them, in the order in which messages list them.
    pub const ALL: [Undecodable; 2] = [Undecodable::Skip, Undecodable::Fail];

    /// The word in topology files and plans.
    pub const fn word(self) -> &'static str {
        match self {
            Undecodable::Skip => "skip",
            Undecodable::Fail => "fail",
        }
    }

    /// The choice with this word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|choice| choice.word() == word)
    }
}

/// What a full queue does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum WhenFull {
    /// The oldest waiting message is dropped.
    #[default]
    DropOldest,
    /// The new message is dropped.
    DropNewest,
    /// The sender waits, if it allows that.
    Wait,
}

impl WhenFull {
    /// All of them, in the order in which messages list them.
    pub const ALL: [WhenFull; 3] = [WhenFull::DropOldest, WhenFull::DropNewest, WhenFull::Wait];

    /// The word in topology files and plans.
    pub const fn word(self) -> &'static str {
        match self {
            WhenFull::DropOldest => "drop_oldest",
            WhenFull::DropNewest => "drop_newest",
            WhenFull::Wait => "wait",
        }
    }

    /// The policy with this word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|policy| policy.word() == word)
    }
}
