//! Messages that can be told apart.

use bytes::Bytes;
use std::fmt;

/// A message: the number of its sender, counting each restart, and its own number among those of that sender.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Message {
    pub(super) sender: u32,
    pub(super) number: u32,
}

impl Message {
    /// Its bytes; length and content depend on the number.
    pub(super) fn frame(self) -> Bytes {
        let head = self.sender.to_be_bytes().into_iter().chain(self.number.to_be_bytes());
        let filling = (0..self.number % 7).map(|index| (self.number + index) as u8);
        head.chain(filling).collect()
    }

    /// The message with these bytes.
    pub(super) fn read(frame: &[u8]) -> Result<Self, String> {
        let word = |from: usize| frame.get(from..from + 4)?.try_into().ok().map(u32::from_be_bytes);
        let message = word(0).zip(word(4)).map(|(sender, number)| Self { sender, number });
        message.filter(|message| message.frame() == frame).ok_or_else(|| format!("{frame:?} was never sent"))
    }
}

impl fmt::Debug for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.sender, self.number)
    }
}
