//! The programs that the supervisor starts and watches.

use super::kept_values::KeptValues;
use super::lock::lock;
use super::policy::Policy;
use super::program::Program;
use std::io::{self, Read};
use std::sync::{Arc, Mutex};

/// A program to supervise.
#[derive(Debug)]
pub(crate) struct Member<'p> {
    pub(crate) name: &'p str,
    /// Its number in the output.
    pub(crate) label: usize,
    pub(crate) role: Role,
    pub(crate) program: &'p Program,
    pub(crate) policy: Policy,
    /// Where the standard output of a build goes, if not to the user.
    pub(crate) messages: Option<Messages>,
    /// The place of its entry in the launch file.
    pub(crate) entry: Option<&'p str>,
    /// What is kept when it is started again.
    pub(crate) kept: KeptValues,
}

/// What a program is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// It makes the program of a component.
    Build,
    /// It runs a component.
    Component,
    /// It connects the components to those of other hosts.
    Gateway,
    /// It records what the components say.
    Recorder,
}

/// What a build writes to its standard output for `scl run` and not for the user.
#[derive(Debug, Clone, Default)]
pub(crate) struct Messages(Arc<Mutex<Vec<u8>>>);

impl Messages {
    /// Removes and returns what has been written so far.
    pub(crate) fn take(&self) -> Vec<u8> {
        std::mem::take(&mut lock(&self.0))
    }

    /// Collects what is written until the stream ends.
    ///
    /// # Errors
    ///
    /// If the stream cannot be read.
    pub(crate) fn read(&self, mut from: impl Read) -> io::Result<()> {
        let mut buffer = vec![0; 64 * 1024];
        loop {
            match from.read(&mut buffer)? {
                0 => return Ok(()),
                count => lock(&self.0).extend_from_slice(&buffer[..count]),
            }
        }
    }
}
