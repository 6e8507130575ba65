//! The options of a gate that its program needs: their values, defaults and names, defined once for the topology file,
//! the JSON text, generated code and the runtime.

use crate::kind::{Undecodable, WhenFull};
use std::time::Duration;

/// Declares the options: name, name in JSON, kind of value with its type, default.
macro_rules! gate_options {
    ($($(#[$doc:meta])* $name:ident $json:literal: $access:ident($type:ty) = $default:expr,)*) => {
        /// The options of a gate that its program needs, defaults filled in.
        #[derive(Debug, Clone, PartialEq, Eq, Hash)]
        pub struct GateOptions {
            $($(#[$doc])* pub $name: $type,)*
        }

        impl GateOptions {
            /// The options of a gate for which the topology file sets none.
            pub const DEFAULT: Self = Self { $($name: $default,)* };

            /// All of them, in the order of the JSON text.
            pub const ALL: &[OptionField] = &[$(OptionField {
                key: stringify!($name),
                json: $json,
                access: OptionAccess::$access(|options| &mut options.$name),
            },)*];
        }
    };
}

gate_options! {
    /// The longest message that the gate accepts, in bytes.
    max_size "max_size": Size(u64) = 64 << 20,
    /// The gate's own queue, in messages. It has an effect for `sub` and `pull`.
    queue "queue": Number(u32) = 100,
    /// What the gate's own queue does when it is full.
    when_full "when_full": Policy(WhenFull) = WhenFull::DropOldest,
    /// Whether a peer with `when_full: wait` may make this gate wait. It has an effect for `pub` and `push`.
    backpressure "backpressure": Flag(bool) = false,
    /// Whether a subscriber that joins or restarts gets the last message at once. It has an effect for `pub`.
    latched "latched": Flag(bool) = false,
    /// How long a call may take: more than zero, at most a day. It has an effect for `req`.
    timeout "timeout_ns": Duration(Duration) = Duration::from_secs(1),
    /// How many calls may be in progress at once, at least one. It has an effect for `req`.
    in_flight "in_flight": Number(u32) = 1,
    /// What a receiving call does with a message that the codec cannot read. It has an effect for `sub`, `pull` and
    /// `rep`.
    undecodable "undecodable": Undecodable(Undecodable) = Undecodable::Skip,
    /// The time from one message to the next that the gate promises: more than zero, at most a day. It has an effect
    /// for `pub` and `push`.
    period "period_ns": Interval(Option<Duration>) = None,
    /// How often the gate needs a message of each peer, in the same range. It has an effect for `sub` and `pull`.
    deadline "deadline_ns": Interval(Option<Duration>) = None,
    /// How old a message may be when the program receives it, in the same range; older ones are dropped. It has an
    /// effect for `sub` and `pull`.
    max_age "max_age_ns": Interval(Option<Duration>) = None,
}

impl GateOptions {
    /// Whether this sending gate waits for a peer with this queue policy, rather than drop a message.
    pub fn waits_for(&self, when_full: WhenFull) -> bool {
        self.backpressure && when_full == WhenFull::Wait
    }

    /// The options of a gate of a component's counterpart in unit tests, which neither drops nor rejects messages. A
    /// call that times out fails the test, so the timeout is long. A message that the gate cannot decode fails the
    /// test, too.
    pub(crate) const COUNTERPART: Self = Self {
        max_size: u64::MAX,
        queue: u32::MAX,
        when_full: WhenFull::Wait,
        backpressure: true,
        timeout: Duration::from_secs(10),
        in_flight: 64,
        undecodable: Undecodable::Fail,
        ..Self::DEFAULT
    };
}

impl Default for GateOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// One of the [`GateOptions`].
#[derive(Debug, Clone, Copy)]
pub struct OptionField {
    /// Its name in the topology file and in Rust.
    pub key: &'static str,
    /// Its name in JSON.
    pub json: &'static str,
    /// How to get at its value.
    pub access: OptionAccess,
}

/// How to get at the value of an option, by its type.
#[derive(Debug, Clone, Copy)]
pub enum OptionAccess {
    /// A whole number.
    Number(fn(&mut GateOptions) -> &mut u32),
    /// A number of bytes.
    Size(fn(&mut GateOptions) -> &mut u64),
    /// A duration; nanoseconds in JSON.
    Duration(fn(&mut GateOptions) -> &mut Duration),
    /// A duration that need not be declared; nanoseconds in JSON, which lacks it then.
    Interval(fn(&mut GateOptions) -> &mut Option<Duration>),
    /// A switch.
    Flag(fn(&mut GateOptions) -> &mut bool),
    /// A queue policy.
    Policy(fn(&mut GateOptions) -> &mut WhenFull),
    /// What happens to undecodable messages.
    Undecodable(fn(&mut GateOptions) -> &mut Undecodable),
}
