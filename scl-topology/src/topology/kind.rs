//! The six kinds of gate.

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

    /// The word in the file.
    pub fn word(self) -> &'static str {
        match self {
            GateKind::Pub => "pub",
            GateKind::Sub => "sub",
            GateKind::Req => "req",
            GateKind::Rep => "rep",
            GateKind::Push => "push",
            GateKind::Pull => "pull",
        }
    }

    /// The kind that sits at the other end.
    pub fn opposite(self) -> GateKind {
        match self {
            GateKind::Pub => GateKind::Sub,
            GateKind::Sub => GateKind::Pub,
            GateKind::Req => GateKind::Rep,
            GateKind::Rep => GateKind::Req,
            GateKind::Push => GateKind::Pull,
            GateKind::Pull => GateKind::Push,
        }
    }

    /// Whether messages start here: `pub`, `push` and `req`.
    pub fn is_source(self) -> bool {
        matches!(self, GateKind::Pub | GateKind::Push | GateKind::Req)
    }

    /// Whether the gate listens and its peers connect to it: `pub`, `rep` and `pull`.
    pub fn listens(self) -> bool {
        matches!(self, GateKind::Pub | GateKind::Rep | GateKind::Pull)
    }
}
