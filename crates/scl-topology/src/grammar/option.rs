//! The options of a gate: one row each. The checks, the schema, the reference page and the generated documentation read
//! the row. At run time, the value is read from the field of the plan's options that has the same key.

use super::queue_policy::POLICIES;
use super::shape::{self, OutOfRange, Shape, Word};
use scl_plan::GateKind::{self, Pub, Pull, Push, Rep, Req, Sub};
use scl_plan::{OptionAccess, Undecodable, WhenFull};
use scl_text::{duration, size};
use std::ops::Deref;
use std::time::Duration;

/// The options of a gate, defaults filled in: those of its program, which can be read as fields of this struct, and
/// those that only the checker needs.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DeclaredOptions {
    /// The options that the program needs.
    pub program: scl_plan::GateOptions,
    /// `share`.
    pub share: bool,
    /// `unconnected: ok`.
    pub unconnected_ok: bool,
}

impl Deref for DeclaredOptions {
    type Target = scl_plan::GateOptions;

    fn deref(&self) -> &Self::Target {
        &self.program
    }
}

impl DeclaredOptions {
    /// The largest `max_size` of a gate: 1 GiB.
    pub const LARGEST_MAX_SIZE: u64 = 1 << 30;
}

/// The longest queue, in messages. Memory is reserved for what a queue may hold, so a longer one is rejected as a
/// typing error.
const LONGEST_QUEUE: u32 = 1_000_000;

/// The longest wait for a reply: a day.
const LONGEST_TIMEOUT: Duration = Duration::from_secs(24 * 60 * 60);

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
        shape: Shape::Duration { most: LONGEST_TIMEOUT },
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

/// An option: what it looks like, which kinds of gate have it, where its value goes.
#[derive(Debug)]
pub struct GateOption {
    /// The key as written in the file.
    pub key: &'static str,
    /// What its value looks like.
    pub shape: Shape,
    /// The kinds of gate that have it.
    pub kinds: &'static [GateKind],
    /// What the option means, in one sentence.
    pub summary: &'static str,
    /// The rest of its documentation, as Markdown.
    pub text: &'static str,
    /// Examples, as entries of `gates`.
    pub examples: &'static [&'static str],
    /// Reasons why some other kinds do not have the option.
    absent: &'static [(&'static [GateKind], &'static str)],
}

/// Where the value of an option goes.
enum Home {
    /// Into the gate itself: `doc` and `codec`.
    Gate,
    /// Into the options of the program, which the plan contains.
    Program(OptionAccess),
    Share,
    Unconnected,
}

/// The option with this key.
pub fn option(key: &str) -> Option<&'static GateOption> {
    OPTIONS.iter().find(|option| option.key == key)
}

impl GateOption {
    /// Whether this kind of gate has it.
    pub fn fits(&self, kind: GateKind) -> bool {
        self.kinds.contains(&kind)
    }

    /// Returns the reason why a kind does not have the option, if `absent` gives one.
    pub fn reason(&self, kind: GateKind) -> Option<&'static str> {
        self.absent.iter().find(|(kinds, _)| kinds.contains(&kind)).map(|(_, reason)| *reason)
    }

    /// Stores a value whose form the parser has checked already.
    ///
    /// # Errors
    ///
    /// The value is out of its range; then nothing is stored.
    pub fn set(&self, options: &mut DeclaredOptions, text: &str) -> Result<(), OutOfRange> {
        let program = &mut options.program;
        match (self.home(), self.shape) {
            (Home::Program(OptionAccess::Number(number)), Shape::Number { least, most }) => {
                *number(program) = shape::number(text, least, most)?;
            }
            (Home::Program(OptionAccess::Duration(duration)), Shape::Duration { most }) => {
                *duration(program) = shape::duration(text, most)?;
            }
            (Home::Program(OptionAccess::Size(size)), Shape::Size { most }) => {
                *size(program) = shape::size(text, most)?;
            }
            (Home::Program(OptionAccess::Flag(flag)), _) => *flag(program) = text == "true",
            (Home::Program(OptionAccess::Policy(policy)), _) => {
                *policy(program) = WhenFull::of(text).unwrap_or_default();
            }
            (Home::Program(OptionAccess::Undecodable(choice)), _) => {
                *choice(program) = Undecodable::of(text).unwrap_or_default();
            }
            (Home::Share, _) => options.share = text == "true",
            (Home::Unconnected, _) => options.unconnected_ok = text == "ok",
            _ => {}
        }
        Ok(())
    }

    /// Returns the value as written in the file. `None` for `doc` and `codec`, whose values are not among
    /// [`DeclaredOptions`], and if no word stands for the value.
    pub fn get(&self, options: &DeclaredOptions) -> Option<String> {
        let mut program = options.program.clone();
        Some(match self.home() {
            Home::Gate => return None,
            Home::Program(OptionAccess::Number(number)) => number(&mut program).to_string(),
            Home::Program(OptionAccess::Duration(length)) => duration::text(*length(&mut program)),
            Home::Program(OptionAccess::Size(bytes)) => size::text(*bytes(&mut program)),
            Home::Program(OptionAccess::Flag(flag)) => flag(&mut program).to_string(),
            Home::Program(OptionAccess::Policy(policy)) => policy(&mut program).word().to_owned(),
            Home::Program(OptionAccess::Undecodable(choice)) => choice(&mut program).word().to_owned(),
            Home::Share => options.share.to_string(),
            Home::Unconnected => return options.unconnected_ok.then(|| "ok".to_owned()),
        })
    }

    fn home(&self) -> Home {
        match scl_plan::GateOptions::ALL.iter().find(|field| field.key == self.key) {
            Some(field) => Home::Program(field.access),
            None if self.key == "share" => Home::Share,
            None if self.key == "unconnected" => Home::Unconnected,
            None => Home::Gate,
        }
    }

    /// Whether the value is stored in the gate itself, not in its [`DeclaredOptions`]: `doc` and `codec`.
    pub fn is_text(&self) -> bool {
        matches!(self.home(), Home::Gate)
    }

    /// The default as in the file, where it has one.
    pub fn default(&self) -> Option<String> {
        self.get(&DeclaredOptions::default())
    }

    /// An example of a value, for messages.
    pub fn example(&self) -> &'static str {
        let text = self.examples.first().copied().unwrap_or("");
        let value = text.split_once(&format!("{}: ", self.key)).map_or("", |(_, value)| value);
        value.split([',', '}']).next().unwrap_or(value)
    }
}

#[cfg(test)]
mod tests {
    use super::{DeclaredOptions, OPTIONS, option};
    use crate::grammar::GateKind;

    #[test]
    fn values_are_read_back_as_they_were_stored() {
        for option in OPTIONS {
            let key = option.key;
            assert!(option.shape.fits(option.example(), true), "{key}: {}", option.example());
            let mut options = DeclaredOptions::default();
            assert_eq!(option.set(&mut options, option.example()), Ok(()), "{key}");
            assert_eq!(option.is_text(), matches!(key, "doc" | "codec"), "{key}");
            if option.is_text() {
                assert_eq!(options, DeclaredOptions::default());
                continue;
            }
            assert_eq!(option.get(&options).as_deref(), Some(option.example()), "{key}");
            let another = OPTIONS.iter().find(|it| it.key != key && it.get(&options) != it.default());
            assert!(another.is_none_or(|it| it.key == "queue"), "{key} sets {another:?}");
        }
    }

    #[test]
    fn every_option_of_a_program_can_be_written() {
        for field in scl_plan::GateOptions::ALL {
            let row = option(field.key).unwrap_or_else(|| panic!("no row `{}`", field.key));
            assert!(row.default().is_some(), "{}", field.key);
        }
    }

    #[test]
    fn a_limit_has_the_reason_of_its_end() {
        let max_size = option("max_size").unwrap();
        let reason = |text| max_size.set(&mut DeclaredOptions::default(), text).map_err(|error| error.reason);
        assert_eq!(reason("0B"), Err(Some("a gate with this limit would accept empty messages only")));
        assert!(reason("2GiB").is_err_and(|reason| reason.is_some_and(|text| text.contains("held in memory"))));
    }

    #[test]
    fn a_kind_has_an_option_or_a_reason_not_to() {
        for option in OPTIONS {
            for kind in GateKind::ALL {
                assert!(!option.fits(kind) || option.reason(kind).is_none(), "{} of {}", option.key, kind.word());
            }
        }
    }
}
