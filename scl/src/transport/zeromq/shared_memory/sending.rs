//! The sending side of a connection.

use super::super::zmtp::{self, PeerReady};
use super::INLINE;
use crate::causes::text_with_causes;
use crate::runtime_dir::SystemDir;
use crate::transport::{Frame, Loan, LoanedMemory};
use bytes::Bytes;
use scl_shm::{LoanedSample, SampleSender, ServiceName, SharedMemory};
use std::collections::VecDeque;
use std::io;
use std::path::PathBuf;

/// The length for which the first segment has room. Longer messages make the engine allocate another one, once.
const EXPECTED: usize = 64 << 10;

/// Shared memory at the sending side.
pub(in super::super) struct Sharing {
    state: State,
    /// Number of long messages that went through the socket because no shared memory was available.
    inline: u64,
}

enum State {
    /// Every message goes through the socket.
    Off,
    /// Both ends can share memory; the receiving one has not opened it yet.
    Agreed {
        service: ServiceName,
        folder: PathBuf,
    },
    Open(Box<Open>),
}

struct Open {
    sender: SampleSender,
    /// Number of samples sent.
    sent: u64,
    /// The numbers of the messages in samples that are not acknowledged, among all messages of the connection.
    unacknowledged: VecDeque<u64>,
}

impl LoanedMemory for LoanedSample {
    fn bytes(&self) -> &[u8] {
        self.as_slice()
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        self.as_mut_slice()
    }
}

impl Sharing {
    pub(in super::super) fn new(dir: &SystemDir, peer: &PeerReady) -> Self {
        let agreed = |service| State::Agreed { service: ServiceName(service), folder: dir.folder().to_owned() };
        Self { state: peer.service.map_or(State::Off, agreed), inline: 0 }
    }

    /// Opens shared memory, after the peer has opened it.
    pub(in super::super) fn open(&mut self) {
        let State::Agreed { service, folder } = std::mem::replace(&mut self.state, State::Off) else { return };
        match SharedMemory::open(&folder).and_then(|memory| memory.sender(service, EXPECTED)) {
            Ok(sender) => {
                self.state = State::Open(Box::new(Open { sender, sent: 0, unacknowledged: VecDeque::new() }));
            }
            Err(error) => tracing::warn!(
                "cannot share memory with a receiving peer, sending through the socket: {}",
                text_with_causes(&error)
            ),
        }
    }

    /// Returns true if one more sample may be unacknowledged.
    pub(in super::super) fn has_room(&self) -> bool {
        match &self.state {
            State::Open(open) => open.unacknowledged.len() < open.sender.in_flight(),
            _ => true,
        }
    }

    /// Returns true if messages of this length are sent as samples.
    pub(in super::super) fn is_for(&self, length: usize) -> bool {
        length > INLINE && matches!(self.state, State::Open(_))
    }

    /// Sends a message as a sample, if it is long and there is memory. `number` is its number among all messages of the
    /// connection. A loan of this link is taken from `message`; anything else is copied. Returns the command that
    /// announces the sample, or `None` if the message is to be sent through the socket.
    ///
    /// # Errors
    /// The message was consumed but not sent; the connection is broken.
    pub(in super::super) fn send(&mut self, message: &mut Frame, number: u64) -> io::Result<Option<[u8; 31]>> {
        let length = message.len();
        if !self.is_for(length) || !self.has_room() {
            return Ok(None);
        }
        let State::Open(open) = &mut self.state else { return Ok(None) };
        let sample = match open.take(message).map_or_else(|| open.sender.copy(message.as_slice()), Ok) {
            Ok(sample) => sample,
            Err(error) => {
                self.count_inline(&error);
                return Ok(None);
            }
        };
        open.sender.send(sample).map_err(io::Error::other)?;
        open.sent += 1;
        open.unacknowledged.push_back(number);
        Ok(Some(zmtp::sample(open.sent, length as u64)))
    }

    /// Handles an acknowledgement of all messages up to a number.
    pub(in super::super) fn acknowledge(&mut self, number: u64) {
        if let State::Open(open) = &mut self.state {
            while open.unacknowledged.front().is_some_and(|&oldest| oldest <= number) {
                open.unacknowledged.pop_front();
            }
        }
    }

    /// Lends memory for a message of this length.
    pub(in super::super) fn loan(&mut self, length: usize) -> Option<Loan> {
        let State::Open(open) = &mut self.state else { return None };
        if length <= INLINE {
            return None;
        }
        match open.sender.loan(length) {
            Ok(sample) => Some(Loan::new(sample)),
            Err(error) => {
                tracing::debug!(%error, "no shared memory is lent");
                None
            }
        }
    }

    fn count_inline(&mut self, error: &scl_shm::LoanError) {
        self.inline += 1;
        // Warn ever more rarely, but not only once, so that the log shows whether this continues.
        if self.inline.is_power_of_two() {
            tracing::warn!("sending long messages through the socket, {} so far: {error}", self.inline);
        }
    }
}

impl Open {
    /// Takes the sample of a frame that this connection has lent.
    fn take(&self, message: &mut Frame) -> Option<LoanedSample> {
        let Frame::Loan(loan) = &*message else { return None };
        loan.downcast_ref().filter(|sample| self.sender.has_lent(sample))?;
        let Frame::Loan(loan) = std::mem::replace(message, Frame::Bytes(Bytes::new())) else { return None };
        loan.downcast().ok().map(|sample| *sample)
    }
}
