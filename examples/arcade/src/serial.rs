//! A pseudo-terminal that other programs can open like a serial port, with a symbolic link to it.

use rustix::fs::{OFlags, fcntl_setfl};
use rustix::io::{Errno, ioctl_fionread};
use rustix::pty::{OpenptFlags, grantpt, ioctl_tiocgptpeer, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};
use std::ffi::OsString;
use std::fs;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

/// When more bytes than these are unread, they are dropped, as a serial port drops what is sent while it is closed.
const MAX_UNREAD: u64 = 400;

/// The end that writes. Dropping it removes the link.
#[derive(Debug)]
pub struct SerialPort {
    master: OwnedFd,
    /// Kept open, so that the port keeps its settings while no other program has it open.
    slave: OwnedFd,
    device: PathBuf,
    link: PathBuf,
}

/// Why there is no serial port.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SerialError {
    #[error("cannot open a pseudo-terminal")]
    Terminal(#[from] Errno),
    #[error("cannot create the link `{}`: {error}\n  = help: choose another path with `--serial`", path.display())]
    Link { path: PathBuf, error: io::Error },
}

impl SerialPort {
    /// Opens a pseudo-terminal and creates `link`. A link to a terminal that an earlier run left behind is replaced.
    ///
    /// # Errors
    /// [`SerialError`] if the operating system has no terminal left, or something else exists at `link`.
    pub fn open(link: &Path) -> Result<Self, SerialError> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        let device = PathBuf::from(OsString::from_vec(ptsname(&master, Vec::new())?.into_bytes()));
        let slave = ioctl_tiocgptpeer(&master, OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        let mut settings = tcgetattr(&slave)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings)?;
        fcntl_setfl(&master, OFlags::RDWR | OFlags::NONBLOCK)?;
        create(link, &device).map_err(|error| SerialError::Link { path: link.to_owned(), error })?;
        Ok(Self { master, slave, device, link: link.to_owned() })
    }

    /// Sends text without waiting for a reader.
    ///
    /// # Errors
    /// Errors of the operating system; a full port is not an error.
    pub fn write(&self, text: &str) -> io::Result<()> {
        if ioctl_fionread(&self.slave)? > MAX_UNREAD {
            tcflush(&self.slave, QueueSelector::IFlush)?;
        }
        match rustix::io::write(&self.master, text.as_bytes()) {
            Ok(_) | Err(Errno::AGAIN) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }
}

impl Drop for SerialPort {
    fn drop(&mut self) {
        // Another simulator may have replaced the link.
        if fs::read_link(&self.link).is_ok_and(|target| target == self.device) {
            let _gone = fs::remove_file(&self.link);
        }
    }
}

fn create(link: &Path, device: &Path) -> io::Result<()> {
    if fs::read_link(link).is_ok_and(|target| target.starts_with("/dev/pts")) {
        fs::remove_file(link)?;
    }
    symlink(device, link)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    fn link(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("arcade-{}-{name}", std::process::id()))
    }

    #[test]
    fn a_program_reads_at_the_link_what_was_written() {
        let link = link("read");
        let port = SerialPort::open(&link).expect("a terminal");
        let mut reader = fs::File::open(&link).expect("the link");
        port.write("$GPGGA\r\n").expect("written");
        let mut text = [0; 8];
        reader.read_exact(&mut text).expect("read");
        assert_eq!(&text, b"$GPGGA\r\n");
        drop(port);
        assert!(!link.is_symlink());
    }

    #[test]
    fn without_a_reader_old_text_is_dropped() {
        let port = SerialPort::open(&link("unread")).expect("a terminal");
        let text = "0123456789".repeat(14);
        for _ in 0..20 {
            let before = ioctl_fionread(&port.slave).expect("a number");
            port.write(&text).expect("written");
            // The kernel delivers a little later.
            while ioctl_fionread(&port.slave).expect("a number") == before {
                std::thread::yield_now();
            }
            let unread = ioctl_fionread(&port.slave).expect("a number");
            assert!(unread <= MAX_UNREAD + 140, "{unread}");
        }
    }

    #[test]
    fn without_a_reader_writing_does_not_wait() {
        let port = SerialPort::open(&link("full")).expect("a terminal");
        let text = "0123456789".repeat(14);
        (0..10_000).for_each(|_| port.write(&text).expect("written"));
    }

    #[test]
    fn only_a_link_to_a_terminal_is_replaced() {
        let (file, old) = (link("file"), link("old"));
        fs::write(&file, "precious").expect("written");
        let error = SerialPort::open(&file).expect_err("a file is there").to_string();
        assert!(error.starts_with("cannot create the link") && error.contains("--serial"), "{error}");
        assert_eq!(fs::read_to_string(&file).expect("still there"), "precious");
        fs::remove_file(&file).expect("removed");
        symlink("/dev/pts/99999", &old).expect("linked");
        assert!(SerialPort::open(&old).is_ok());
    }
}
