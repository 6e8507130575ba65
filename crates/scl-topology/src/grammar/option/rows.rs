//! The rows of all options.

use super::{DeclaredOptions, GateOption};
use crate::grammar::queue_policy::POLICIES;
use crate::grammar::shape::{Shape, Word};
use scl_plan::GateKind::{self, Pub, Pull, Push, Rep, Req, Sub};
use scl_plan::Undecodable;
use std::time::Duration;

/// The longest queue, in messages. Memory is reserved for what a queue may hold, so a longer one is rejected as a
/// typing error.
const LONGEST_QUEUE: u32 = 1_000_000;

/// Why exchanges have no rate.
const NO_RATE: (&[GateKind], &str) = (&[Req, Rep], "a call is made when its program needs a reply");

/// The longest wait for a reply, and the longest time between messages: a day.
const LONGEST_TIME: Duration = Duration::from_secs(24 * 60 * 60);

/// Maximum number of calls that a gate may have in progress: equal to the number of unread replies that a replier keeps
/// for a requester.
const MOST_IN_FLIGHT: u32 = 64;

/// Why other kinds have no queue.
const NO_QUEUE: &[(&[GateKind], &str)] = &[
    (&[Req, Rep], "a requester limits its unanswered calls with `in_flight` and `timeout`"),
    (&[Pub, Push], "each receiver says how many messages may wait for it"),
];

/// All options, in the order in which messages list them.
pub static OPTIONS: &[GateOption] = &[
    GateOption {
        key: "doc",
        shape: Shape::Text,
        kinds: &GateKind::ALL,
        summary: "A paragraph for the generated documentation.",
        text: "Editors show it when the cursor is on the gate's field.",
        examples: &["attitude: {pub: Attitude, doc: Roll and pitch at 100 Hz.}"],
        absent: &[],
    },
    GateOption {
        key: "codec",
        shape: Shape::Codec,
        kinds: &GateKind::ALL,
        summary: "How messages become bytes; if not set, the codec of the other end or of the file is used.",
        text: "Both ends of a connection use the same codec, so it is enough to name it at one of them. A gate without \
               a type carries bytes as they are, whatever its `codec`. See [codecs](#codecs).",
        examples: &["attitude: {pub: Attitude, codec: json}", "position: {pub: Position, codec: my_crate::Flat}"],
        absent: &[],
    },
    GateOption {
        key: "queue",
        shape: Shape::Number { least: 1, most: LONGEST_QUEUE },
        kinds: &[Sub, Pull],
        summary: "How many messages may wait for this gate; 1 means: only the newest.",
        text: "Counted in messages, for each connection. `when_full` says what happens when it is full. A queue of 1 \
               with `drop_oldest` always holds the newest value, even after the receiver paused: no older message \
               waits in a socket. At any other gate, up to 4096 messages or 1 MiB more may be on their way between the \
               two programs.",
        examples: &["attitude: {sub: Attitude, queue: 1}"],
        absent: NO_QUEUE,
    },
    GateOption {
        key: "when_full",
        shape: Shape::Word(&POLICIES),
        kinds: &[Sub, Pull],
        summary: "What a full queue does: drop the oldest message, drop the newest, or make the sender wait.",
        text: "`wait` needs `backpressure: true` at the sender. See [queue policies](#queue-policies).",
        examples: &["samples: {sub: Sample, queue: 1000, when_full: drop_newest}"],
        absent: NO_QUEUE,
    },
    GateOption {
        key: "backpressure",
        shape: Shape::Boolean,
        kinds: &[Pub, Push],
        summary: "Allows a receiver with `when_full: wait` to make this gate wait.",
        text: "Both ends must agree, so that no sender waits by surprise. Receivers with another `when_full` are not \
               affected. For a receiver in an `optional` component, the gate waits only while that component is \
               connected; while it is not, a full queue drops its oldest message, and the drop is counted.",
        examples: &["samples: {pub: Sample, backpressure: true}"],
        absent: &[(&[Sub, Pull], "a receiver asks for it with `when_full: wait`")],
    },
    GateOption {
        key: "latched",
        shape: Shape::Boolean,
        kinds: &[Pub],
        summary: "A subscriber that joins or restarts gets the last message at once.",
        text: "For state that seldom changes, such as a mode or a configuration: the publisher need not send it again \
               and again, or wait for its first subscriber. This works over every transport, between hosts, and in \
               every language. The last message comes after those that wait in the queue, whatever `when_full` says. \
               The subscriber can ask how old it is (`latched_age`), by the publisher's clock; between hosts, the time \
               on the network is not included. A subscriber that stays connected, or reconnects, gets each message \
               once, unless a gateway between them restarts. A plain ZeroMQ subscriber gets the last message each time \
               it connects, or subscribes to its topic later, and does not learn its age. The publisher's memory holds \
               a copy of the message, so a publisher that restarts has none until it sends one.",
        examples: &["mode: {pub: Mode, latched: true}"],
        absent: &[
            (&[Sub], "the publisher keeps its last message, for all of its subscribers"),
            (&[Push, Pull], "each message goes to one puller, once"),
            (&[Req, Rep], "a reply belongs to one call"),
        ],
    },
    GateOption {
        key: "max_size",
        shape: Shape::Size { most: DeclaredOptions::LARGEST_MAX_SIZE },
        kinds: &[Sub, Pull, Req, Rep],
        summary: "The longest message that this gate accepts.",
        text: "Checked before memory is reserved. A sender refuses a message that is longer than a receiver accepts. \
               A message of `schemas` whose decoding would take more than 16 times this size in memory (at least 16 MiB) is \
               undecodable.",
        examples: &["image: {sub: Image, max_size: 8MiB}"],
        absent: &[(&[Pub, Push], "each receiving gate sets its own limit")],
    },
    GateOption {
        key: "timeout",
        shape: Shape::Duration { most: LONGEST_TIME },
        kinds: &[Req],
        summary: "How long a call may take.",
        text: "Measured from the call to the reply. A reply that arrives later is dropped. If the replier itself makes \
               calls before it answers, this timeout must be longer than theirs.",
        examples: &["set_mode: {req: Mode -> Accepted, timeout: 500ms}"],
        absent: &[(&[Rep], "each requester says how long it waits")],
    },
    GateOption {
        key: "in_flight",
        shape: Shape::Number { least: 1, most: MOST_IN_FLIGHT },
        kinds: &[Req],
        summary: "How many calls may be in progress at once.",
        text: "For programs that call from several tasks. A call beyond the limit waits, within its timeout, until \
               another one ends. Each reply is matched with its request; a replier may answer in any order, or handle \
               one request after the other.",
        examples: &["tiles: {req: Area -> Tile, in_flight: 8}"],
        absent: &[(&[Rep], "a replier may hold any number of requests")],
    },
    GateOption {
        key: "undecodable",
        shape: Shape::Word(&[
            Word {
                word: Undecodable::Skip.word(),
                summary: "the message is counted and skipped",
                text: "The call continues with the next message.",
            },
            Word { word: Undecodable::Fail.word(), summary: "the call fails", text: "Later calls are not affected." },
        ]),
        kinds: &[Sub, Pull, Rep],
        summary: "What a receiving call does with a message that the codec cannot read: skip it, or fail.",
        text: "With `skip`, the message is counted as `undecodable`, the first one of each peer is logged with the \
               reason, and the call continues with the next message within its time limit. With `fail`, the call \
               returns the error. Either way the sender of an undecodable request is notified at once, so its call \
               fails before its timeout.",
        examples: &["commands: {pull: Command, undecodable: fail}"],
        absent: &[
            (&[Pub, Push], "each receiving gate says what it does with messages that it cannot read"),
            (&[Req], "an undecodable reply fails the call that it answers"),
        ],
    },
    GateOption {
        key: "rate",
        shape: Shape::Rate { longest: LONGEST_TIME },
        kinds: &[Pub, Push],
        summary: "How often this gate promises to send, in messages per second.",
        text: "`rate: 100Hz` says the same as `period: 10ms`. See [time](#time).",
        examples: &["attitude: {pub: Attitude, rate: 100Hz}"],
        absent: &[(&[Sub, Pull], "a receiver says with `deadline` how often it needs a message"), NO_RATE],
    },
    GateOption {
        key: "period",
        shape: Shape::Duration { most: LONGEST_TIME },
        kinds: &[Pub, Push],
        summary: "The time from one message to the next that this gate promises.",
        text: "The checker compares it with the `deadline` of each receiver. At run time, a message that has not been \
               sent half a period after it was due is counted as missed, from the first message on. See \
               [time](#time).",
        examples: &["attitude: {pub: Attitude, period: 10ms}"],
        absent: &[(&[Sub, Pull], "a receiver says with `deadline` how often it needs a message"), NO_RATE],
    },
    GateOption {
        key: "deadline",
        shape: Shape::Duration { most: LONGEST_TIME },
        kinds: &[Sub, Pull],
        summary: "How often this gate needs a message: at least once in this time, of each sender.",
        text: "The sender must promise it with `rate` or `period`. At run time, each time without a message is counted \
               as missed, from when the sender has connected, and also while it is not running, unless its component \
               is `optional`. Nothing else happens: the program decides what to do. See [time](#time).",
        examples: &["attitude: {sub: Attitude, deadline: 20ms}"],
        absent: &[
            (&[Pub, Push], "a sender says with `rate` or `period` how often it sends"),
            (&[Req, Rep], "a requester says with `timeout` how long it waits for a reply"),
        ],
    },
    GateOption {
        key: "max_age",
        shape: Shape::Duration { most: LONGEST_TIME },
        kinds: &[Sub, Pull],
        summary: "How old a message may be when the program receives it; older ones are dropped.",
        text: "The age begins when the sender sends the message, and grows while it waits in queues, too. Each message \
               that is dropped is counted as `expired`. One of a program that does not tell when it has sent it, such \
               as a plain ZeroMQ program, is as old as it is here. See [time](#time).",
        examples: &["attitude: {sub: Attitude, max_age: 50ms}"],
        absent: &[
            (&[Pub, Push], "a receiver says with `max_age` which messages are too old for it"),
            (&[Req, Rep], "a requester says with `timeout` how long it waits for a reply"),
        ],
    },
    GateOption {
        key: "share",
        shape: Shape::Boolean,
        kinds: &[Push],
        summary: "Several pullers share the work: each message goes to one of them.",
        text: "Without it, a `push` gate has one puller.",
        examples: &["jobs: {push: Job, share: true}"],
        absent: &[(&[Pub], "every subscriber gets every message")],
    },
    GateOption {
        key: "unconnected",
        shape: Shape::Word(&[Word { word: "ok", summary: "no peer is needed", text: "" }]),
        kinds: &GateKind::ALL,
        summary: "`ok`: this gate is meant to have no peer, so nothing warns about it.",
        text: "Without it, a gate that is not connected is a warning, or an error for a `req` gate, whose calls could \
               only fail.",
        examples: &["debug: {pub: Trace, unconnected: ok}"],
        absent: &[],
    },
];
