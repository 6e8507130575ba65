//! What the listening gates of a component listen on.

/// What a component listens on. Connecting gates find either by themselves, so the components of a system may differ.
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
    const ALL: [Self; 3] = [Self::Ipc, Self::Tcp, Self::Shm];

    /// The transport that a word of `SCL_TRANSPORT` means.
    pub(crate) fn parse(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.word() == word)
    }

    /// Its word in `SCL_TRANSPORT`.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Ipc => "ipc",
            Self::Tcp => "tcp",
            Self::Shm => "shm",
        }
    }
}
