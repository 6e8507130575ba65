//! The options of a gate that its program needs: their values, defaults and names, defined once for the topology file,
//! the JSON text, generated code and the runtime.

use crate::kind::{Undecodable, WhenFull};
use std::time::Duration;

/// The options of a gate that its program needs, defaults filled in.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct GateOptions {
    /// The longest message that the gate accepts, in bytes.
    pub max_size: u64,
    /// The gate's own queue, in messages. It has an effect for `sub` and `pull`.
    pub queue: u32,
    /// What the gate's own queue does when it is full.
    pub when_full: WhenFull,
    /// Whether a peer with `when_full: wait` may make this gate wait. It has an effect for `pub` and `push`.
    pub backpressure: bool,
    /// Whether a subscriber that joins or restarts gets the last message at once. It has an effect for `pub`.
    pub latched: bool,
    /// How long a call may take: more than zero, at most a day. It has an effect for `req`.
    pub timeout: Duration,
    /// How many calls may be in progress at once, at least one. It has an effect for `req`.
    pub in_flight: u32,
    /// What a receiving call does with a message that the codec cannot read. It has an effect for `sub`, `pull` and
    /// `rep`.
    pub undecodable: Undecodable,
}

impl GateOptions {
    /// The options of a gate for which the topology file sets none: 64 MiB, 100 messages, 1 s, one call at a time.
    pub const DEFAULT: Self = Self {
        max_size: 64 << 20,
        queue: 100,
        when_full: WhenFull::DropOldest,
        backpressure: false,
        latched: false,
        timeout: Duration::from_secs(1),
        in_flight: 1,
        undecodable: Undecodable::Skip,
    };

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

    /// All of them, in the order of the JSON text.
    pub const ALL: &[OptionField] = &[
        field("max_size", OptionAccess::Size(|options| &mut options.max_size)),
        field("queue", OptionAccess::Number(|options| &mut options.queue)),
        field("when_full", OptionAccess::Policy(|options| &mut options.when_full)),
        field("backpressure", OptionAccess::Flag(|options| &mut options.backpressure)),
        field("latched", OptionAccess::Flag(|options| &mut options.latched)),
        OptionField { json: "timeout_ns", ..field("timeout", OptionAccess::Duration(|options| &mut options.timeout)) },
        field("in_flight", OptionAccess::Number(|options| &mut options.in_flight)),
        field("undecodable", OptionAccess::Undecodable(|options| &mut options.undecodable)),
    ];
}

/// A field with one name everywhere.
const fn field(key: &'static str, access: OptionAccess) -> OptionField {
    OptionField { key, json: key, access }
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
    /// A switch.
    Flag(fn(&mut GateOptions) -> &mut bool),
    /// A queue policy.
    Policy(fn(&mut GateOptions) -> &mut WhenFull),
    /// What happens to undecodable messages.
    Undecodable(fn(&mut GateOptions) -> &mut Undecodable),
}

#[cfg(test)]
mod tests {
    use super::GateOptions;

    #[test]
    fn every_field_is_in_the_list() {
        let debug = format!("{:?}", GateOptions::DEFAULT);
        let fields: Vec<&str> =
            debug.split([',', '{']).filter_map(|part| part.split_once(": ")).map(|it| it.0.trim()).collect();
        assert_eq!(fields, GateOptions::ALL.iter().map(|option| option.key).collect::<Vec<_>>());
    }
}
