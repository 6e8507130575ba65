//! What a receiving gate got: numbered messages of senders, each at most once and in order.

use std::collections::HashMap;
use std::fmt;

/// The least a message has: the sender's mark and the message's number.
pub(crate) const SMALLEST: usize = 16;

/// A numbered message. `mark` tells one run of a sender from its next.
pub(crate) fn message(mark: u64, number: u64, size: usize) -> Vec<u8> {
    let mut bytes = [mark.to_le_bytes(), number.to_le_bytes()].concat();
    // What comes after must arrive unchanged, too.
    bytes.resize(size.max(SMALLEST), number as u8);
    bytes
}

/// The counts of a receiver.
#[derive(Debug, Default)]
pub(crate) struct Receipts {
    last: HashMap<u64, u64>,
    /// Messages taken.
    pub(crate) count: u64,
    /// Messages that came again, or after a later one.
    pub(crate) out_of_order: u64,
    /// Numbers that were left out between two messages of one sender.
    pub(crate) gaps: u64,
    /// Messages whose bytes are not those that were sent.
    pub(crate) damaged: u64,
    /// The number of the latest message.
    pub(crate) newest: u64,
    /// Its sender.
    pub(crate) mark: u64,
}

impl Receipts {
    pub(crate) fn take(&mut self, message: &[u8]) {
        self.count += 1;
        let (Some(mark), Some(number)) = (word(message, 0), word(message, 8)) else {
            self.damaged += 1;
            return;
        };
        if message[SMALLEST..].iter().any(|byte| *byte != number as u8) {
            self.damaged += 1;
        }
        // Numbers start with 1.
        let last = self.last.insert(mark, number).unwrap_or(0);
        if number <= last {
            self.out_of_order += 1;
            self.last.insert(mark, last);
        } else {
            self.gaps += number - last - 1;
        }
        (self.newest, self.mark) = (number, mark);
    }
}

fn word(message: &[u8], from: usize) -> Option<u64> {
    Some(u64::from_le_bytes(message.get(from..from + 8)?.try_into().ok()?))
}

impl fmt::Display for Receipts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { count, out_of_order, gaps, damaged, newest, mark, .. } = self;
        write!(f, "count={count} out_of_order={out_of_order} gaps={gaps} damaged={damaged} newest={newest} mark={mark}")
    }
}

#[test]
fn receipts_find_what_is_wrong() {
    let mut receipts = Receipts::default();
    for (mark, number) in [(1, 1), (1, 2), (2, 1), (1, 5), (1, 5), (1, 3), (2, 2)] {
        receipts.take(&message(mark, number, 100));
    }
    let mut damaged = message(1, 6, 100);
    damaged[40] = 0;
    receipts.take(&damaged);
    assert_eq!(receipts.to_string(), "count=8 out_of_order=2 gaps=2 damaged=1 newest=6 mark=1");
}
