//! The decisions of a receiving end: which message is next, which is a duplicate, which is missing.

use std::time::Instant;

use bytes::{Bytes, BytesMut};

use crate::wire::header::{Ack, Header, Kind};

/// The state of one epoch.
#[derive(Debug, Default)]
pub(super) struct Incoming {
    epoch: u64,
    max_size: u64,
    stream: Option<u64>,
    attempt: u32,
    /// Messages of this stream that arrived.
    received: u64,
    /// Messages of earlier streams of this epoch.
    base: u64,
    /// Messages that the component has taken in this epoch.
    taken: u64,
    partial: Option<Partial>,
    /// The last gap that was reported: one report is enough until something changes.
    reported: Option<(u32, u64)>,
}

#[derive(Debug)]
struct Partial {
    sequence: u64,
    attempt: u32,
    bytes: BytesMut,
}

/// The result of [`Incoming::accept`].
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Outcome {
    pub(super) message: Option<Bytes>,
    /// When that message was sent, if it was before this receiver had joined.
    pub(super) latched: Option<Instant>,
    pub(super) answer: Option<Ack>,
    pub(super) flush: bool,
    /// Whether the sender violates `max_size`. The message is not accepted, so the stream gets no further.
    pub(super) too_large: bool,
}

impl Incoming {
    pub(super) fn new(epoch: u64, max_size: u64) -> Self {
        Incoming { epoch, max_size, ..Incoming::default() }
    }

    pub(super) fn accept(&mut self, header: Header, payload: Bytes) -> Outcome {
        if header.epoch != self.epoch {
            return Outcome::default();
        }
        if self.stream != Some(header.stream) {
            if let Kind::Probe { .. } = header.kind {
                return Outcome { answer: Some(self.nothing_of(&header)), ..Outcome::default() };
            }
            if header.sequence != 1 {
                let answer = self.report(&header).then(|| self.nothing_of(&header));
                return Outcome { answer, ..Outcome::default() };
            }
            self.base += self.received;
            (self.stream, self.received, self.partial, self.reported) = (Some(header.stream), 0, None, None);
        }
        self.attempt = header.attempt;
        let latched = header.latched;
        let outcome = match header.kind {
            Kind::Probe { flush } => Outcome {
                answer: self.answer(header.sequence),
                flush: flush && header.sequence > 0,
                ..Outcome::default()
            },
            Kind::Whole if header.sequence == self.received + 1 => self.complete(payload),
            Kind::Chunk { offset, total } if header.sequence == self.received + 1 => {
                self.chunk(&header, offset, total, &payload)
            }
            _ => self.out_of_order(&header),
        };
        Outcome { latched: latched.filter(|_| outcome.message.is_some()), ..outcome }
    }

    /// Notes that the component has taken `count` messages of this epoch.
    pub(super) fn acknowledge(&mut self, count: u64) -> Option<Ack> {
        self.taken = self.taken.max(count.min(self.base + self.received));
        self.answer(self.received)
    }

    fn complete(&mut self, message: Bytes) -> Outcome {
        self.partial = None;
        if message.len() as u64 > self.max_size {
            return Outcome { too_large: true, ..Outcome::default() };
        }
        self.received += 1;
        Outcome { message: Some(message), ..Outcome::default() }
    }

    fn chunk(&mut self, header: &Header, offset: u64, total: u64, payload: &[u8]) -> Outcome {
        if total > self.max_size || offset.saturating_add(payload.len() as u64) > total {
            return Outcome { too_large: offset == 0, ..Outcome::default() };
        }
        if offset == 0 {
            // Do not preallocate: `total` is only a claim of the sender.
            self.partial = Some(Partial { sequence: header.sequence, attempt: header.attempt, bytes: BytesMut::new() });
        }
        let continues = |partial: &&mut Partial| {
            (partial.sequence, partial.attempt, partial.bytes.len() as u64) == (header.sequence, header.attempt, offset)
        };
        let Some(partial) = self.partial.as_mut().filter(continues) else {
            return self.out_of_order(header);
        };
        partial.bytes.extend_from_slice(payload);
        if (partial.bytes.len() as u64) < total {
            return Outcome::default();
        }
        let message = std::mem::take(&mut partial.bytes).freeze();
        self.complete(message)
    }

    /// Acknowledges a duplicate again, or reports a gap.
    fn out_of_order(&mut self, header: &Header) -> Outcome {
        let is_due = match header.sequence <= self.received {
            true => header.sequence == self.received,
            false => self.report(header),
        };
        Outcome { answer: self.answer(header.sequence).filter(|_| is_due), ..Outcome::default() }
    }

    fn report(&mut self, header: &Header) -> bool {
        let news = Some((header.attempt, self.received));
        std::mem::replace(&mut self.reported, news) != news
    }

    fn answer(&self, seen: u64) -> Option<Ack> {
        let taken = self.taken.saturating_sub(self.base);
        let (epoch, attempt, received) = (self.epoch, self.attempt, self.received);
        debug_assert!(taken <= received, "{taken} messages are acknowledged of {received}");
        Some(Ack { stream: self.stream?, epoch, attempt, received, taken, seen })
    }

    fn nothing_of(&self, header: &Header) -> Ack {
        let Header { stream, epoch, attempt, sequence, .. } = *header;
        Ack { stream, epoch, attempt, received: 0, taken: 0, seen: sequence }
    }
}

#[cfg(test)]
mod tests;
