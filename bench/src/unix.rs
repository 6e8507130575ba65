//! Unix sockets without ZMTP: a frame is the length of its payload in four bytes, and the payload.

use std::io::{self, Read};
use std::ops::Range;
use std::os::unix::net::UnixStream as StdUnixStream;
use tokio::io::{AsyncRead, AsyncReadExt};

/// Bytes before the payload.
pub(crate) const PREFIX: usize = 4;

/// Capacity for reading several short frames at once, as SCL and the libraries do.
const READ_SIZE: usize = 64 << 10;

/// Bytes that have been read from a stream, and the frames in them.
pub(crate) struct FrameBuffer {
    bytes: Vec<u8>,
    /// The bytes that have been read but not returned.
    unread: Range<usize>,
}

impl FrameBuffer {
    /// A buffer for frames of up to `payload_size` bytes of payload.
    pub(crate) fn new(payload_size: usize) -> Self {
        Self { bytes: vec![0; (PREFIX + payload_size).max(READ_SIZE)], unread: 0..0 }
    }

    /// Reads until a frame is complete, and returns it with its prefix.
    pub(crate) async fn read(&mut self, stream: &mut (impl AsyncRead + Unpin)) -> io::Result<&[u8]> {
        loop {
            if let Some(frame) = self.next_frame() {
                return Ok(&self.bytes[frame]);
            }
            let read = stream.read(self.free()).await?;
            self.fill(read)?;
        }
    }

    /// [`read`](Self::read) for a blocking stream.
    pub(crate) fn read_blocking(&mut self, stream: &mut StdUnixStream) -> io::Result<&[u8]> {
        loop {
            if let Some(frame) = self.next_frame() {
                return Ok(&self.bytes[frame]);
            }
            let read = stream.read(self.free())?;
            self.fill(read)?;
        }
    }

    fn next_frame(&mut self) -> Option<Range<usize>> {
        let prefix = self.bytes[self.unread.clone()].first_chunk::<PREFIX>()?;
        let size = PREFIX + u32::from_be_bytes(*prefix) as usize;
        if self.unread.len() < size {
            return None;
        }
        let frame = self.unread.start..self.unread.start + size;
        self.unread.start = frame.end;
        Some(frame)
    }

    /// Returns the space after the unread bytes, which are moved to the start if there is none.
    fn free(&mut self) -> &mut [u8] {
        if self.unread.is_empty() || self.unread.end == self.bytes.len() {
            self.bytes.copy_within(self.unread.clone(), 0);
            self.unread = 0..self.unread.len();
        }
        &mut self.bytes[self.unread.end..]
    }

    fn fill(&mut self, read: usize) -> io::Result<()> {
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        self.unread.end += read;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    /// A frame whose payload is all zeros.
    fn zeroed_frame(payload_size: usize) -> Vec<u8> {
        let mut frame = vec![0; PREFIX + payload_size];
        frame[..PREFIX].copy_from_slice(&u32::try_from(payload_size).unwrap().to_be_bytes());
        frame
    }

    #[test]
    fn frames_are_found_however_they_are_split() {
        let (mut near, mut far) = StdUnixStream::pair().unwrap();
        let sizes = [20, 0, READ_SIZE - 7, 3, 70_000, 1];
        let sent: Vec<Vec<u8>> = sizes.into_iter().map(zeroed_frame).collect();
        let bytes = sent.concat();
        let writer = std::thread::spawn(move || {
            for chunk in bytes.chunks(999) {
                near.write_all(chunk).unwrap();
            }
        });
        let mut frames = FrameBuffer::new(70_000);
        for frame in &sent {
            assert!(frames.read_blocking(&mut far).unwrap() == frame);
        }
        writer.join().unwrap();
        assert_eq!(frames.read_blocking(&mut far).unwrap_err().kind(), io::ErrorKind::UnexpectedEof);
    }
}
