//! The programs that the supervisor starts and watches.

use super::children::{Messages, Role};
use super::policy::Policy;
use super::program::Program;

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
    /// Where the launch file has its entry.
    pub(crate) entry: Option<&'p str>,
}
