//! The status codes.

use std::ffi::{CStr, c_char};

/// What a call returns: `SCL_OK`, or a negative number that says why it did not do what it was asked to do.
#[allow(non_camel_case_types)]
pub type scl_status = i32;

/// Done.
pub const SCL_OK: scl_status = 0;
/// No message has arrived yet. Only calls with a timeout of 0 and `scl_latest` return it.
pub const SCL_NOTHING: scl_status = -1;
/// The queue of a peer with `when_full: wait` is full. Only `scl_send` with a timeout of 0 returns it; nothing was
/// sent.
pub const SCL_FULL: scl_status = -2;
/// The time limit is over.
pub const SCL_TIMEOUT: scl_status = -3;
/// The program was asked to stop by SIGTERM or SIGINT. Return from `main`; this is not a failure.
pub const SCL_STOPPED: scl_status = -4;
/// The peer disconnected after the request was sent; whether it acted on the request is unknown.
pub const SCL_PEER_LOST: scl_status = -5;
/// The peer that made a request no longer waits for the reply.
pub const SCL_REQUESTER_GONE: scl_status = -6;
/// Another thread is using this gate. Use each gate from one thread at a time.
pub const SCL_BUSY: scl_status = -7;
/// The message is longer than the peer accepts (`max_size` in the topology file). It was not sent.
pub const SCL_TOO_LONG: scl_status = -8;
/// The buffer is too small. Nothing is lost: the size needed was stored, and the next call returns the same message.
pub const SCL_BUFFER: scl_status = -9;
/// The bytes received are not a message.
pub const SCL_DECODE: scl_status = -10;
/// Not all peers have taken all messages. The component was closed nevertheless.
pub const SCL_NOT_FLUSHED: scl_status = -11;
/// The replier could not decode the request, so it did not act on it.
pub const SCL_REFUSED: scl_status = -12;
/// The bytes to send are not a message: a text in them is not UTF-8. They were not sent.
pub const SCL_ENCODE: scl_status = -13;
/// A wrong argument: a NULL pointer, a text that is not UTF-8, a length that no object can have, a wrong option.
pub const SCL_ARGUMENT: scl_status = -20;
/// The handle was closed or freed, or never was one.
pub const SCL_HANDLE: scl_status = -21;
/// The system has no component, or the component no gate or parameter, with this name.
pub const SCL_NAME: scl_status = -22;
/// The gate is of another kind: for example, `scl_send` with a gate that receives. Or the parameter is of another type.
pub const SCL_KIND: scl_status = -23;
/// The plan is not valid, or was written for another version of SCL.
pub const SCL_PLAN: scl_status = -24;
/// Another process, or this one, is already running the component.
pub const SCL_TAKEN: scl_status = -25;
/// The runtime folder cannot be used.
pub const SCL_FOLDER: scl_status = -26;
/// An environment variable has a value that is not understood, or a parameter has no value or a wrong one.
pub const SCL_ENVIRONMENT: scl_status = -27;
/// The component was closed by another thread during the call.
pub const SCL_CLOSED: scl_status = -28;
/// The handle belongs to the parent process. Open a component in one process only.
pub const SCL_FORKED: scl_status = -29;
/// The operating system refused something.
pub const SCL_SYSTEM: scl_status = -30;
/// A bug in SCL. The text says where; please report it.
pub const SCL_PANIC: scl_status = -31;
/// Any other failure.
pub const SCL_FAILED: scl_status = -32;

/// The names of all statuses.
const NAMES: &[(scl_status, &CStr)] = &[
    (SCL_OK, c"SCL_OK"),
    (SCL_NOTHING, c"SCL_NOTHING"),
    (SCL_FULL, c"SCL_FULL"),
    (SCL_TIMEOUT, c"SCL_TIMEOUT"),
    (SCL_STOPPED, c"SCL_STOPPED"),
    (SCL_PEER_LOST, c"SCL_PEER_LOST"),
    (SCL_REQUESTER_GONE, c"SCL_REQUESTER_GONE"),
    (SCL_BUSY, c"SCL_BUSY"),
    (SCL_TOO_LONG, c"SCL_TOO_LONG"),
    (SCL_BUFFER, c"SCL_BUFFER"),
    (SCL_DECODE, c"SCL_DECODE"),
    (SCL_NOT_FLUSHED, c"SCL_NOT_FLUSHED"),
    (SCL_REFUSED, c"SCL_REFUSED"),
    (SCL_ENCODE, c"SCL_ENCODE"),
    (SCL_ARGUMENT, c"SCL_ARGUMENT"),
    (SCL_HANDLE, c"SCL_HANDLE"),
    (SCL_NAME, c"SCL_NAME"),
    (SCL_KIND, c"SCL_KIND"),
    (SCL_PLAN, c"SCL_PLAN"),
    (SCL_TAKEN, c"SCL_TAKEN"),
    (SCL_FOLDER, c"SCL_FOLDER"),
    (SCL_ENVIRONMENT, c"SCL_ENVIRONMENT"),
    (SCL_CLOSED, c"SCL_CLOSED"),
    (SCL_FORKED, c"SCL_FORKED"),
    (SCL_SYSTEM, c"SCL_SYSTEM"),
    (SCL_PANIC, c"SCL_PANIC"),
    (SCL_FAILED, c"SCL_FAILED"),
];

/// Returns the name of a status: `"SCL_TIMEOUT"` for `SCL_TIMEOUT`. Never NULL; the text is constant.
#[unsafe(no_mangle)]
pub extern "C" fn scl_status_name(status: scl_status) -> *const c_char {
    name(status).as_ptr()
}

fn name(status: scl_status) -> &'static CStr {
    NAMES.iter().find(|(known, _)| *known == status).map_or(c"unknown status", |(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_status_has_its_own_number_and_name() {
        let header = include_str!("../include/scl.h");
        let defined: Vec<&str> = header.lines().filter(|line| line.starts_with("#define SCL_")).collect();
        for (index, (status, expected)) in NAMES.iter().enumerate() {
            assert_eq!(name(*status), *expected);
            assert!(NAMES[..index].iter().all(|(other, _)| other != status), "{expected:?}");
            let definition = format!("#define {} {status}", expected.to_str().unwrap());
            assert!(defined.contains(&definition.as_str()), "{definition}");
        }
        let value = |line: &str| line.rsplit(' ').next().and_then(|value| value.parse::<scl_status>().ok());
        let negative = defined.iter().filter(|line| value(line).is_some_and(|value| value < 0)).count();
        assert_eq!(negative, NAMES.len() - 1, "each status of the header has a name");
        assert_eq!(name(7), c"unknown status");
        assert_eq!(name(scl_status::MIN), c"unknown status");
    }
}
