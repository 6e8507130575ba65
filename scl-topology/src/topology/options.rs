//! The options of a gate.

use std::time::Duration;

/// What a full queue does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WhenFull {
    /// The oldest waiting message is dropped.
    DropOldest,
    /// The new message is dropped.
    DropNewest,
    /// The sender waits, if it allows that.
    Wait,
}

impl WhenFull {
    /// All of them, in the order in which messages list them.
    pub const ALL: [WhenFull; 3] = [WhenFull::DropOldest, WhenFull::DropNewest, WhenFull::Wait];

    /// The words of [`ALL`](Self::ALL).
    pub const WORDS: [&'static str; 3] = {
        let [first, second, third] = Self::ALL;
        [first.word(), second.word(), third.word()]
    };

    /// The word in the file.
    pub const fn word(self) -> &'static str {
        match self {
            WhenFull::DropOldest => "drop_oldest",
            WhenFull::DropNewest => "drop_newest",
            WhenFull::Wait => "wait",
        }
    }
}

/// The options of a gate, defaults filled in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GateOptions {
    /// `queue`: how many messages may wait for this gate. Default 100.
    pub queue: u32,
    /// `when_full`. Default `drop_oldest`.
    pub when_full: WhenFull,
    /// `backpressure`. Default false.
    pub backpressure: bool,
    /// `max_size`: the longest message that this gate accepts, in bytes: from 1 to
    /// [`LARGEST_MAX_SIZE`](Self::LARGEST_MAX_SIZE). Default 64 MiB.
    pub max_size: u64,
    /// `timeout` of a call. Default 1 s.
    pub timeout: Duration,
    /// `share`. Default false.
    pub share: bool,
    /// `unconnected: ok`. Default false.
    pub unconnected_ok: bool,
}

impl GateOptions {
    /// The largest `max_size` of a gate: 1 GiB.
    pub const LARGEST_MAX_SIZE: u64 = 1 << 30;
}

impl Default for GateOptions {
    fn default() -> Self {
        Self {
            queue: 100,
            when_full: WhenFull::DropOldest,
            backpressure: false,
            max_size: 64 << 20,
            timeout: Duration::from_secs(1),
            share: false,
            unconnected_ok: false,
        }
    }
}
