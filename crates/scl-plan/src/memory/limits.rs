//! The limits of the runtime on what is on its way between two programs, in bytes unless said otherwise. They are
//! constants of SCL and not options, so they are defined here, for the runtime and for the figures of
//! [`GateMemory`](super::GateMemory).

/// How many messages a receiving end lets its sender have unacknowledged.
pub const WINDOW_MESSAGES: u64 = 4096;
/// How many bytes of messages it lets its sender have unacknowledged; one message may exceed that.
pub const WINDOW_BYTES: u64 = 1 << 20;
/// [`WINDOW_MESSAGES`] of a gate to which only the newest message matters: little enough to fit into the socket's
/// buffers, so that a message has either arrived or been announced as waiting.
pub const NEWEST_WINDOW_MESSAGES: u64 = 64;
/// [`WINDOW_BYTES`] of such a gate.
pub const NEWEST_WINDOW_BYTES: u64 = 32 << 10;

/// How many bytes of short messages a sender writes together at most; a longer message is written by itself.
pub const BATCH: usize = 64 << 10;

/// Memory for each read from a peer whose messages are long, so that few of them are cut in two and copied.
pub const READ: usize = 256 << 10;

/// How many bytes of requests or replies may wait for a peer that does not read. The next one may exceed that.
pub const UNREAD_BYTES: usize = 1 << 20;
/// How many pieces may wait for a peer that does not read: a batch of messages, answers to its heartbeats, requests or
/// replies.
pub const UNREAD_PIECES: usize = 64;
/// The number of pieces of one of them: its envelope, the header of its last frame, and its body.
pub const PIECES_OF_A_MESSAGE: usize = 3;
