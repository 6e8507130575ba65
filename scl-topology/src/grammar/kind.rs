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

/// What the file format says about a kind.
#[derive(Debug, PartialEq, Eq)]
pub struct KindRow {
    /// The word in the file.
    pub word: &'static str,
    /// The kind at the other end of a connection.
    pub opposite: GateKind,
    /// Whether messages start here.
    pub is_source: bool,
    /// What such a gate does, in one sentence.
    pub summary: &'static str,
    /// How many connections it may have, in one sentence.
    pub peers: &'static str,
    /// What other frameworks and people call it, in lower case.
    pub synonyms: &'static [&'static str],
}

/// Two kinds that connect to each other.
#[derive(Debug, PartialEq, Eq)]
pub struct Pattern {
    /// The kind that starts.
    pub source: GateKind,
    /// Who talks to whom, in a few words.
    pub summary: &'static str,
}

/// The three patterns of communication.
pub static PATTERNS: [Pattern; 3] = [
    Pattern { source: GateKind::Pub, summary: "one to many, no answer" },
    Pattern { source: GateKind::Req, summary: "question and answer" },
    Pattern { source: GateKind::Push, summary: "many to one, no answer" },
];

impl GateKind {
    /// All kinds, in the order in which messages list them.
    pub const ALL: [GateKind; 6] =
        [GateKind::Pub, GateKind::Sub, GateKind::Req, GateKind::Rep, GateKind::Push, GateKind::Pull];

    /// The row of the table.
    pub const fn row(self) -> &'static KindRow {
        match self {
            GateKind::Pub => &KindRow {
                word: "pub",
                opposite: GateKind::Sub,
                is_source: true,
                summary: "Sends messages to any number of subscribers.",
                peers: "Any number of `sub` gates; each gets every message.",
                synonyms: &["publish", "publisher", "publishes", "out", "output", "source", "sender", "topic"],
            },
            GateKind::Sub => &KindRow {
                word: "sub",
                opposite: GateKind::Pub,
                is_source: false,
                summary: "Receives messages from one or several publishers.",
                peers: "Any number of `pub` gates; their messages arrive mixed, in the order of arrival.",
                synonyms: &["subscribe", "subscriber", "subscribes", "in", "input", "sink", "receiver", "listener"],
            },
            GateKind::Req => &KindRow {
                word: "req",
                opposite: GateKind::Rep,
                is_source: true,
                summary: "Sends a request to one replier and waits for the reply.",
                peers: "One `rep` gate.",
                synonyms: &["client", "request", "requester", "call", "caller", "ask"],
            },
            GateKind::Rep => &KindRow {
                word: "rep",
                opposite: GateKind::Req,
                is_source: false,
                summary: "Answers the requests of any number of requesters.",
                peers: "Any number of `req` gates.",
                synonyms: &["server", "service", "reply", "replier", "response", "responder", "answer"],
            },
            GateKind::Push => &KindRow {
                word: "push",
                opposite: GateKind::Pull,
                is_source: true,
                summary: "Hands work to a puller.",
                peers: "One `pull` gate; several with `share: true`, each message goes to one of them.",
                synonyms: &["pusher", "pushes"],
            },
            GateKind::Pull => &KindRow {
                word: "pull",
                opposite: GateKind::Push,
                is_source: false,
                summary: "Takes work from any number of pushers.",
                peers: "Any number of `push` gates.",
                synonyms: &["puller", "pulls"],
            },
        }
    }

    /// The kind of a word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.word() == word)
    }

    /// The word in the file.
    pub const fn word(self) -> &'static str {
        self.row().word
    }

    /// The kind that sits at the other end.
    pub const fn opposite(self) -> GateKind {
        self.row().opposite
    }

    /// Whether messages start here: `pub`, `push` and `req`.
    pub const fn is_source(self) -> bool {
        self.row().is_source
    }

    /// Whether the gate listens and its peers connect to it: `pub`, `rep` and `pull`.
    pub const fn listens(self) -> bool {
        matches!(self, GateKind::Pub | GateKind::Rep | GateKind::Pull)
    }

    /// Whether the gate has a request and a reply type: `req` and `rep`.
    pub const fn is_exchange(self) -> bool {
        matches!(self, GateKind::Req | GateKind::Rep)
    }
}

#[cfg(test)]
mod tests {
    use super::{GateKind, PATTERNS};

    #[test]
    fn kinds_come_in_pairs() {
        for kind in GateKind::ALL {
            assert_eq!(GateKind::of(kind.word()), Some(kind));
            assert_eq!(kind.opposite().opposite(), kind);
            assert_ne!(kind.is_source(), kind.opposite().is_source());
        }
        let of_patterns: Vec<GateKind> = PATTERNS.iter().flat_map(|it| [it.source, it.source.opposite()]).collect();
        assert_eq!(of_patterns, GateKind::ALL);
    }
}
