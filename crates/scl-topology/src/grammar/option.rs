//! The options of a gate: one row each. The checks, the schema, the reference page and the generated documentation read
//! the row; what the option does at run time reads the field of [`GateOptions`] that the row names.

use super::queue_policy::POLICIES;
use super::shape::{self, OutOfRange, Shape, Word};
use crate::{duration, size};
use scl_plan::GateKind::{self, Pub, Pull, Push, Rep, Req, Sub};
use scl_plan::{Undecodable, WhenFull};
use std::ops::{Deref, DerefMut};
use std::time::Duration;

/// The options of a gate, defaults filled in: those of its program, which read as if they were here, and those of the
/// checker alone.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct GateOptions {
    /// Those that the program needs.
    pub program: scl_plan::GateOptions,
    /// `share`.
    pub share: bool,
    /// `unconnected: ok`.
    pub unconnected_ok: bool,
}

impl Deref for GateOptions {
    type Target = scl_plan::GateOptions;

    fn deref(&self) -> &Self::Target {
        &self.program
    }
}

impl DerefMut for GateOptions {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.program
    }
}

impl GateOptions {
    /// The largest `max_size` of a gate: 1 GiB.
    pub const LARGEST_MAX_SIZE: u64 = 1 << 30;
}

/// The longest queue, in messages. Memory is reserved for what a queue may hold, so a typing error is refused.
const LONGEST_QUEUE: u32 = 1_000_000;

/// The longest wait for a reply: a day.
const LONGEST_TIMEOUT: Duration = Duration::from_secs(24 * 60 * 60);

/// The most calls that a gate may have in progress: as many unread replies as a replier keeps for a requester.
const MOST_IN_FLIGHT: u32 = 64;

/// All options, in the order in which messages list them.
pub static OPTIONS: [GateOption; 12] = [
    GateOption {
        key: "doc",
        shape: Shape::Text,
        kinds: &GateKind::ALL,
        field: Field::Elsewhere,
        summary: "A paragraph for the generated documentation.",
        text: "Editors show it when the cursor is on the gate's field.",
        examples: &["attitude: {pub: Attitude, doc: Roll and pitch at 100 Hz.}"],
        absent: &[],
        limits: ["", ""],
    },
    GateOption {
        key: "codec",
        shape: Shape::Codec,
        kinds: &GateKind::ALL,
        field: Field::Elsewhere,
        summary: "How messages become bytes; without it, the codec of the other end, or that of the file.",
        text: "Both ends of a connection have the same codec, so one of them is enough to say it. A gate without a type \
               carries bytes as they are, whatever its `codec`. See [codecs](#codecs).",
        examples: &["attitude: {pub: Attitude, codec: json}", "position: {pub: Position, codec: my_crate::Flat}"],
        absent: &[],
        limits: ["", ""],
    },
    GateOption {
        key: "queue",
        shape: Shape::Number { least: 1, most: LONGEST_QUEUE },
        kinds: &[Sub, Pull],
        field: Field::Number(|options| &mut options.queue),
        summary: "How many messages may wait for this gate; 1 means: only the newest.",
        text: "Counted in messages, for each connection. What happens when it is full is `when_full`. A queue of 1 with \
               `drop_oldest` always holds the newest value, also after a pause of the receiver: nothing older waits in \
               a socket. At any other gate, up to 4096 messages or 1 MiB more may be on their way between the two \
               programs.",
        examples: &["attitude: {sub: Attitude, queue: 1}"],
        absent: &[
            (&[Req, Rep], "`req` and `rep` take turns, so there is never more than one message waiting"),
            (&[Pub, Push], "each receiver says how many messages may wait for it"),
        ],
        limits: ["", ""],
    },
    GateOption {
        key: "when_full",
        shape: Shape::Word(&POLICIES),
        kinds: &[Sub, Pull],
        field: Field::Word {
            read: |options| Some(options.when_full.word()),
            write: |options, word| options.when_full = WhenFull::of(word).unwrap_or(options.when_full),
        },
        summary: "What a full queue does: drop the oldest message, drop the newest, or make the sender wait.",
        text: "`wait` needs `backpressure: true` at the sender. See [queue policies](#queue-policies).",
        examples: &["samples: {sub: Sample, queue: 1000, when_full: drop_newest}"],
        absent: &[
            (&[Req, Rep], "`req` and `rep` take turns, so there is never more than one message waiting"),
            (&[Pub, Push], "each receiver says how many messages may wait for it"),
        ],
        limits: ["", ""],
    },
    GateOption {
        key: "backpressure",
        shape: Shape::Boolean,
        kinds: &[Pub, Push],
        field: Field::Switch(|options| &mut options.backpressure),
        summary: "Allows a receiver with `when_full: wait` to make this gate wait.",
        text: "Both ends agree to it, so that no sender waits by surprise. Receivers with another `when_full` are not \
               affected. For a receiver in an `optional` component the gate waits only while it is connected; without \
               it, a full queue drops its oldest message, which is counted.",
        examples: &["samples: {pub: Sample, backpressure: true}"],
        absent: &[(&[Sub, Pull], "a receiver asks for it with `when_full: wait`")],
        limits: ["", ""],
    },
    GateOption {
        key: "latched",
        shape: Shape::Boolean,
        kinds: &[Pub],
        field: Field::Switch(|options| &mut options.latched),
        summary: "A subscriber that joins or restarts gets the last message at once.",
        text: "For state that seldom changes, such as a mode or a configuration, so that nobody has to send it again and \
               again, or wait for its first subscriber. This holds over every transport, between hosts, and in every language. \
               The last message comes after those that wait in the queue, whatever `when_full` says. The subscriber can ask \
               how old it is (`latched_age`), by the publisher's clock; between hosts, the time on the network is not part of \
               that. One that stays connected, or reconnects, gets each message once, unless a gateway between them restarts. \
               A plain ZeroMQ subscriber gets the last message each time that it connects, or subscribes to its topic later, \
               and does not learn its age. The publisher's memory holds a copy of the message, so a publisher that restarts \
               has none until it sends one.",
        examples: &["mode: {pub: Mode, latched: true}"],
        absent: &[
            (&[Sub], "the publisher keeps its last message, for all of its subscribers"),
            (&[Push, Pull], "each message goes to one puller, once"),
            (&[Req, Rep], "a reply belongs to one call"),
        ],
        limits: ["", ""],
    },
    GateOption {
        key: "max_size",
        shape: Shape::Size { most: GateOptions::LARGEST_MAX_SIZE },
        kinds: &[Sub, Pull, Req, Rep],
        field: Field::Size(|options| &mut options.max_size),
        summary: "The longest message that this gate accepts.",
        text: "Checked before memory is reserved. A sender refuses a message that is longer than a receiver accepts. \
               A message of `schemas` whose decoding would take more than 16 times this size in memory (at least 16 MiB) is \
               undecodable.",
        examples: &["image: {sub: Image, max_size: 8MiB}"],
        absent: &[(&[Pub, Push], "each receiving gate sets its own limit")],
        limits: [
            "a gate with this limit would accept empty messages only",
            "a message is held in memory as a whole; send larger data in several messages",
        ],
    },
    GateOption {
        key: "timeout",
        shape: Shape::Duration { most: LONGEST_TIMEOUT },
        kinds: &[Req],
        field: Field::Duration(|options| &mut options.timeout),
        summary: "How long a call may take.",
        text: "Counted from the call until the reply. A reply that arrives later is dropped. If the replier makes calls \
               of its own before it answers, this timeout has to be longer than theirs.",
        examples: &["set_mode: {req: Mode -> Accepted, timeout: 500ms}"],
        absent: &[(&[Rep], "each requester says how long it waits")],
        limits: ["", ""],
    },
    GateOption {
        key: "in_flight",
        shape: Shape::Number { least: 1, most: MOST_IN_FLIGHT },
        kinds: &[Req],
        field: Field::Number(|options| &mut options.in_flight),
        summary: "How many calls may be in progress at once.",
        text: "For programs that call from several tasks. A call beyond the limit waits, within its timeout, until another one \
               ends. Each reply is matched with its request; a replier may answer in any order, or take one request after \
               the other.",
        examples: &["tiles: {req: Area -> Tile, in_flight: 8}"],
        absent: &[(&[Rep], "a replier may hold any number of requests")],
        limits: ["", ""],
    },
    GateOption {
        key: "undecodable",
        shape: Shape::Word(&[
            Word {
                word: Undecodable::Skip.word(),
                summary: "the message is counted and skipped",
                text: "The call goes on with the next message.",
            },
            Word { word: Undecodable::Fail.word(), summary: "the call fails", text: "The next call goes on." },
        ]),
        kinds: &[Sub, Pull, Rep],
        field: Field::Word {
            read: |options| Some(options.undecodable.word()),
            write: |options, word| options.undecodable = Undecodable::of(word).unwrap_or(options.undecodable),
        },
        summary: "What a receiving call does with a message that the codec cannot read: skip it, or fail.",
        text: "With `skip`, the message is counted as `undecodable`, the first one of each peer is logged with the \
               reason, and the call goes on with the next message within its time. With `fail`, the call returns the \
               error. Either way the sender of an undecodable request is told at once, so its call fails before its timeout.",
        examples: &["commands: {pull: Command, undecodable: fail}"],
        absent: &[
            (&[Pub, Push], "each receiving gate says what it does with messages that it cannot read"),
            (&[Req], "an undecodable reply fails the call that it answers"),
        ],
        limits: ["", ""],
    },
    GateOption {
        key: "share",
        shape: Shape::Boolean,
        kinds: &[Push],
        field: Field::Switch(|options| &mut options.share),
        summary: "Several pullers share the work: each message goes to one of them.",
        text: "Without it, a `push` gate has one puller.",
        examples: &["jobs: {push: Job, share: true}"],
        absent: &[(&[Pub], "every subscriber gets every message")],
        limits: ["", ""],
    },
    GateOption {
        key: "unconnected",
        shape: Shape::Word(&[Word { word: "ok", summary: "no peer is needed", text: "" }]),
        kinds: &GateKind::ALL,
        field: Field::Word {
            read: |options| options.unconnected_ok.then_some("ok"),
            write: |options, word| options.unconnected_ok = word == "ok",
        },
        summary: "`ok`: this gate is meant to have no peer, so nothing warns about it.",
        text: "Without it, a gate without a connection is a warning, and an error at a `req` gate, whose calls could only \
               fail.",
        examples: &["debug: {pub: Trace, unconnected: ok}"],
        absent: &[],
        limits: ["", ""],
    },
];

/// An option: what it looks like, which kinds of gate have it, where its value goes.
#[derive(Debug)]
pub struct GateOption {
    /// As in the file.
    pub key: &'static str,
    /// What its value looks like.
    pub shape: Shape,
    /// The kinds of gate that have it.
    pub kinds: &'static [GateKind],
    /// What it says, in one sentence.
    pub summary: &'static str,
    /// The rest of what there is to know, as Markdown.
    pub text: &'static str,
    /// Entries of `gates`.
    pub examples: &'static [&'static str],
    /// Why other kinds do not have it, where there is more to say than that.
    absent: &'static [(&'static [GateKind], &'static str)],
    /// Why a value below or above its range cannot work; empty where the range says enough.
    limits: [&'static str; 2],
    field: Field,
}

/// Where the value of an option goes.
#[derive(Debug)]
enum Field {
    /// Not into [`GateOptions`].
    Elsewhere,
    Number(fn(&mut GateOptions) -> &mut u32),
    Duration(fn(&mut GateOptions) -> &mut Duration),
    Size(fn(&mut GateOptions) -> &mut u64),
    Switch(fn(&mut GateOptions) -> &mut bool),
    Word {
        read: fn(&GateOptions) -> Option<&'static str>,
        write: fn(&mut GateOptions, &str),
    },
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

    /// Why a kind does not have it, if there is more to say than that.
    pub fn reason(&self, kind: GateKind) -> Option<&'static str> {
        self.absent.iter().find(|(kinds, _)| kinds.contains(&kind)).map(|(_, reason)| *reason)
    }

    /// Why a value out of range cannot work, if there is more to say than the range.
    pub fn limit(&self, error: &OutOfRange) -> Option<&'static str> {
        Some(self.limits[usize::from(error.is_above)]).filter(|text| !text.is_empty())
    }

    /// Stores a value that looks right; the parser has seen to that.
    ///
    /// # Errors
    ///
    /// The value is out of its range; then nothing is stored.
    pub fn set(&self, options: &mut GateOptions, text: &str) -> Result<(), OutOfRange> {
        match (&self.field, self.shape) {
            (Field::Number(field), Shape::Number { least, most }) => {
                *field(options) = shape::number(text, least, most)?;
            }
            (Field::Duration(field), Shape::Duration { most }) => *field(options) = shape::duration(text, most)?,
            (Field::Size(field), Shape::Size { most }) => *field(options) = shape::size(text, most)?,
            (Field::Switch(field), _) => *field(options) = text == "true",
            (Field::Word { write, .. }, _) => write(options, text),
            _ => {}
        }
        Ok(())
    }

    /// The value as in the file. None for `doc` and `codec`, whose values are not among [`GateOptions`], and where no
    /// word stands for the value.
    pub fn get(&self, options: &GateOptions) -> Option<String> {
        let mut options = options.clone();
        match &self.field {
            Field::Elsewhere => None,
            Field::Number(field) => Some(field(&mut options).to_string()),
            Field::Duration(field) => Some(duration::text(*field(&mut options))),
            Field::Size(field) => Some(size::text(*field(&mut options))),
            Field::Switch(field) => Some(field(&mut options).to_string()),
            Field::Word { read, .. } => read(&options).map(str::to_owned),
        }
    }

    /// Whether the gate has the value itself, not its [`GateOptions`]: `doc` and `codec`.
    pub fn is_text(&self) -> bool {
        matches!(self.field, Field::Elsewhere)
    }

    /// The default as in the file, where it has one.
    pub fn default(&self) -> Option<String> {
        self.get(&GateOptions::default())
    }

    /// A value, for messages.
    pub fn example(&self) -> &'static str {
        let text = self.examples.first().copied().unwrap_or("");
        let value = text.split_once(&format!("{}: ", self.key)).map_or("", |(_, value)| value);
        value.split([',', '}']).next().unwrap_or(value)
    }
}

#[cfg(test)]
mod tests {
    use super::{Field, GateOptions, OPTIONS, Shape, option};
    use crate::grammar::GateKind;

    #[test]
    fn values_are_read_back_as_they_were_stored() {
        for option in &OPTIONS {
            let key = option.key;
            assert!(option.shape.fits(option.example(), true), "{key}: {}", option.example());
            let mut options = GateOptions::default();
            assert_eq!(option.set(&mut options, option.example()), Ok(()), "{key}");
            match option.field {
                Field::Elsewhere => assert_eq!(options, GateOptions::default()),
                _ => {
                    assert_eq!(option.get(&options).as_deref(), Some(option.example()), "{key}");
                    let another = OPTIONS.iter().find(|it| it.key != key && it.get(&options) != it.default());
                    assert!(another.is_none_or(|it| it.key == "queue"), "{key} sets {another:?}");
                }
            }
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
        let reason = |text| max_size.set(&mut GateOptions::default(), text).map_err(|error| max_size.limit(&error));
        assert_eq!(reason("0B"), Err(Some("a gate with this limit would accept empty messages only")));
        assert!(reason("2GiB").is_err_and(|reason| reason.is_some_and(|text| text.contains("held in memory"))));
    }

    #[test]
    fn a_kind_has_an_option_or_a_reason_not_to() {
        for option in &OPTIONS {
            for kind in GateKind::ALL {
                assert!(!option.fits(kind) || option.reason(kind).is_none(), "{} of {}", option.key, kind.word());
            }
            let has_limits = matches!(option.shape, Shape::Number { .. } | Shape::Size { .. } | Shape::Duration { .. });
            assert!(has_limits || option.limits == ["", ""], "{}", option.key);
        }
    }
}
