//! What the listening gates of a component listen on.

/// What a component listens on. Connecting gates find out by themselves, so the components of a system may differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TransportKind {
    /// Unix sockets in the runtime folder.
    #[default]
    Ipc,
    /// TCP on 127.0.0.1, with the ports in the runtime folder.
    Tcp,
    /// Unix sockets in the runtime folder, which offer shared memory for long messages. A peer that does not use shared
    /// memory is served through the socket. Needs the feature `shm` of the crate `scl`.
    Shm,
}

impl TransportKind {
    const ALL: [(Self, &str); 3] = [(Self::Ipc, "ipc"), (Self::Tcp, "tcp"), (Self::Shm, "shm")];

    /// The words of `SCL_TRANSPORT` and of launch files.
    pub const WORDS: [&str; 3] = {
        let [(_, ipc), (_, tcp), (_, shm)] = Self::ALL;
        [ipc, tcp, shm]
    };

    /// Returns the transport that a word names.
    pub(crate) fn parse(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, it)| *it == word).map(|(kind, _)| kind)
    }

    /// Returns the word for this transport.
    pub(crate) fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}
