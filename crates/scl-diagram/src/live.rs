//! What a picture of a running system shows besides its parts.

/// What a component is doing, the worst last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum State {
    /// It does not run.
    Stopped,
    /// It runs, and all required peers are connected, as far as is known.
    Running,
    /// It waits for peers.
    Waiting,
    /// It runs, and does nothing.
    Hanging,
    /// It was killed or has crashed.
    Dead,
}

/// What a gate has done.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figures {
    /// Messages per second as a text, `300/s`; empty for none.
    pub rate: String,
    /// The same as a number.
    pub per_second: f64,
    /// How full its queue is, from 0 to 1.
    pub filled: f64,
    /// What went wrong so far, `12 dropped`; empty for nothing.
    pub trouble: String,
    /// Whether that goes on.
    pub is_bad: bool,
}

/// What flows through the connections of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Flow {
    /// One of them is not connected.
    NotConnected,
    /// Nothing.
    Idle,
    /// This many messages per second.
    Messages(f64),
    /// Messages that are dropped.
    Dropping,
}

impl State {
    /// One word: `waiting`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stopped => "stopped",
            Self::Running => "running",
            Self::Waiting => "waiting",
            Self::Hanging => "hanging",
            Self::Dead => "dead",
        }
    }

    /// What a picture says in words; nothing where the border is enough.
    pub(crate) fn badge(self) -> &'static str {
        match self {
            Self::Stopped | Self::Running => "",
            Self::Waiting | Self::Hanging | Self::Dead => self.word(),
        }
    }
}

impl Flow {
    /// One word: `idle`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::NotConnected => "unconnected",
            Self::Idle => "idle",
            Self::Messages(_) => "messages",
            Self::Dropping => "dropping",
        }
    }

    /// The width of the edge in pixels: one more for each factor of ten.
    #[must_use]
    pub fn width(self) -> f64 {
        match self {
            Self::Messages(per_second) => 1.2 + (1.0 + per_second.max(0.0)).log10(),
            Self::NotConnected | Self::Idle => 1.2,
            Self::Dropping => 2.5,
        }
    }
}
