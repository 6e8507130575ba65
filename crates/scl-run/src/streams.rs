//! The output of simulated programs. It is read at the end of each turn, and not by threads, so that the lines of all
//! programs come in the same order in each run.

use super::event::Event;
use super::log_file::LogStream;
use super::output::Output;
use rustix::event::{Timespec, epoll};
use rustix::fs::OFlags;
use rustix::io::Errno;
use std::io;
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;

/// How much a program can print in one turn without waiting, in bytes. It needs no privileges up to here.
const ROOM: usize = 1 << 20;
const READ: usize = 64 << 10;

/// The streams of all programs.
#[derive(Debug)]
pub(crate) struct Streams {
    ready: OwnedFd,
    open: Vec<Stream>,
    next: u64,
}

#[derive(Debug)]
struct Stream {
    number: u64,
    process: usize,
    /// The number of its program in the output.
    label: usize,
    kind: LogStream,
    pipe: OwnedFd,
    /// The beginning of a line.
    line: Vec<u8>,
}

impl Streams {
    pub(crate) fn new() -> io::Result<Self> {
        Ok(Self { ready: epoll::create(epoll::CreateFlags::CLOEXEC)?, open: Vec::new(), next: 0 })
    }

    /// Reads a stream of a process from now on.
    pub(crate) fn add(&mut self, process: usize, label: usize, kind: LogStream, pipe: OwnedFd) -> io::Result<()> {
        rustix::fs::fcntl_setfl(&pipe, OFlags::NONBLOCK)?;
        // A program that prints more waits a little for each part.
        let _smaller = rustix::pipe::fcntl_setpipe_size(&pipe, ROOM);
        let number = self.next;
        self.next += 1;
        epoll::add(&self.ready, &pipe, epoll::EventData::new_u64(number), epoll::EventFlags::IN)?;
        self.open.push(Stream { number, process, label, kind, pipe, line: Vec::new() });
        Ok(())
    }

    /// Shows what has been printed since the last call. Passes on which streams have ended.
    pub(crate) fn read(&mut self, output: &Output, mut ended: impl FnMut(Event)) {
        let mut events = [MaybeUninit::<epoll::Event>::uninit(); 16];
        loop {
            let Ok((found, _)) = epoll::wait(&self.ready, &mut events, Some(&Timespec::default())) else { return };
            // In the order in which they were added: that of the events depends on the kernel.
            let mut numbers: Vec<u64> = found.iter().map(|event| event.data.u64()).collect();
            if numbers.is_empty() {
                return;
            }
            numbers.sort_unstable();
            for number in numbers {
                let Some(index) = self.open.iter().position(|stream| stream.number == number) else { continue };
                if self.open[index].read(output) {
                    // Closing the pipe removes it from the epoll descriptor.
                    ended(Event::StreamClosed { process: self.open.remove(index).process });
                }
            }
        }
    }
}

impl Stream {
    /// Shows what has arrived. Returns true if nothing more will.
    fn read(&mut self, output: &Output) -> bool {
        let mut buffer = [0; READ];
        loop {
            match rustix::io::read(&self.pipe, &mut buffer) {
                Ok(count @ 1..) => {
                    self.line.extend_from_slice(&buffer[..count]);
                    output.show_lines(self.label, self.kind, &mut self.line);
                }
                Err(Errno::INTR) => {}
                Err(Errno::AGAIN) => return false,
                Ok(0) | Err(_) => {
                    if !self.line.is_empty() {
                        self.line.push(b'\n');
                        output.show_lines(self.label, self.kind, &mut self.line);
                    }
                    return true;
                }
            }
        }
    }
}
