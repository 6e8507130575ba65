//! What the file format says about the six kinds of gate. Their words belong to the plan, which other languages read.

use scl_plan::GateKind;

/// What the file format says about a kind.
#[derive(Debug, PartialEq, Eq)]
pub struct KindRow {
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
    /// The kind that sends first: `pub`, `req` or `push`.
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

impl KindRow {
    /// The row of a kind.
    pub const fn of(kind: GateKind) -> &'static KindRow {
        match kind {
            GateKind::Pub => &KindRow {
                summary: "Sends messages to any number of subscribers.",
                peers: "Any number of `sub` gates; each gets every message.",
                synonyms: &[
                    "publish",
                    "publisher",
                    "publishes",
                    "out",
                    "output",
                    "source",
                    "sender",
                    "topic",
                    "advertise",
                    "advertiser",
                    "emit",
                    "emits",
                    "emitter",
                    "producer",
                    "produce",
                    "produces",
                    "writer",
                    "datawriter",
                    "write",
                    "pport",
                    "broadcast",
                    "outport",
                ],
            },
            GateKind::Sub => &KindRow {
                summary: "Receives messages from one or several publishers.",
                peers: "Any number of `pub` gates; their messages arrive mixed, in the order of arrival.",
                synonyms: &[
                    "subscribe",
                    "subscriber",
                    "subscribes",
                    "in",
                    "input",
                    "sink",
                    "receiver",
                    "listener",
                    "subscription",
                    "consumer",
                    "consume",
                    "consumes",
                    "reader",
                    "datareader",
                    "read",
                    "receive",
                    "recv",
                    "rport",
                    "inport",
                    "listen",
                ],
            },
            GateKind::Req => &KindRow {
                summary: "Sends a request to one replier and waits for the reply.",
                peers: "One `rep` gate.",
                synonyms: &["client", "request", "requester", "call", "caller", "ask", "serviceclient", "consult"],
            },
            GateKind::Rep => &KindRow {
                summary: "Answers the requests of any number of requesters.",
                peers: "Any number of `req` gates.",
                synonyms: &[
                    "server",
                    "service",
                    "reply",
                    "replier",
                    "response",
                    "responder",
                    "answer",
                    "rpc",
                    "srv",
                    "serviceserver",
                    "advertiseservice",
                    "procedure",
                    "method",
                ],
            },
            GateKind::Push => &KindRow {
                summary: "Hands work to a puller.",
                peers: "One `pull` gate; several with `share: true`, each message goes to one of them.",
                synonyms: &["pusher", "pushes", "enqueue", "offer"],
            },
            GateKind::Pull => &KindRow {
                summary: "Takes work from any number of pushers.",
                peers: "Any number of `push` gates.",
                synonyms: &["puller", "pulls", "worker", "dequeue", "take"],
            },
        }
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
