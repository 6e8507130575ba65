//! The part of `scl __start` in a simulation: the program finds its seat, and gets the same address space in each run.

use rustix::process::getpid;
use scl_terminal::print_err;
use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;

/// The variable by which the library finds its seat; other processes that inherit it ignore it.
const SEAT: &str = "SCL_SIMULATION";
/// The format of what the library and the conductor say to each other. The library repeats it (`turn.c`).
pub const SEAT_FORMAT: u32 = 1;
const PRELOAD: &str = "LD_PRELOAD";

/// The value of the option `--seat` of `scl __start`: a socket, an epoll descriptor and a library.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SeatArgument {
    descriptors: String,
    library: OsString,
}

impl SeatArgument {
    /// Reads the value.
    ///
    /// # Errors
    ///
    /// If it does not have three parts.
    pub fn parse(value: &OsStr) -> Result<Self, &'static str> {
        let mut parts = value.as_bytes().splitn(3, |byte| *byte == b',');
        let mut next = || parts.next().ok_or("expected `SOCKET,EPOLL,LIBRARY`");
        let (socket, watched, library) = (next()?, next()?, next()?);
        let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
        let descriptors = format!("{},{}", text(socket), text(watched));
        Ok(Self { descriptors, library: OsStr::from_bytes(library).to_owned() })
    }

    /// Prepares this process, which becomes the program, and returns the variables of the program.
    pub(crate) fn take(&self) -> Vec<(&'static str, OsString)> {
        // Addresses decide the order in which some hash maps are iterated.
        let fixed = nix::sys::personality::get()
            .and_then(|now| nix::sys::personality::set(now | nix::sys::personality::Persona::ADDR_NO_RANDOMIZE));
        if let Err(error) = fixed {
            print_err(&format!("scl: addresses in the program differ from run to run: {error}\n"));
        }
        let mut preload = self.library.clone();
        // Several libraries are separated by spaces or colons.
        if let Some(others) = std::env::var_os(PRELOAD).filter(|others| !others.is_empty()) {
            preload.push(":");
            preload.push(others);
        }
        let seat = format!("{SEAT_FORMAT},{},{}", getpid().as_raw_pid(), self.descriptors);
        vec![(SEAT, seat.into()), (PRELOAD, preload), ("PYTHONHASHSEED", "0".into())]
    }
}
