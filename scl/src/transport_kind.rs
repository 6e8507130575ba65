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
    /// In the order of the variants.
    const ALL: &[(Self, &str)] = &[(Self::Ipc, "ipc"), (Self::Tcp, "tcp"), (Self::Shm, "shm")];

    /// The words of `SCL_TRANSPORT` and of launch files.
    pub const WORDS: &[&str] = &{
        let mut words = [""; Self::ALL.len()];
        let mut index = 0;
        while index < words.len() {
            words[index] = Self::ALL[index].1;
            index += 1;
        }
        words
    };

    /// Returns the transport that a word names.
    pub(crate) fn parse(word: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, it)| *it == word).map(|(kind, _)| *kind)
    }

    /// Returns the word of `SCL_TRANSPORT` and of launch files.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}
