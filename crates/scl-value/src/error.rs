//! Why a message is not read or written.

use scl_terminal::{Problem, closest_name};
use thiserror::Error;

/// The messages of a type cannot be read or written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TypeError {
    /// The codec is `protobuf`, and nothing describes the type.
    #[error("there is no schema for the protobuf message `{name}`: its program was built without `schemas:`")]
    Undescribed {
        /// The type.
        name: String,
    },
    /// The codec is `protobuf`, and the descriptors do not contain the type.
    #[error("the schema has no message `{name}`")]
    Unknown {
        /// The type.
        name: String,
    },
    /// The descriptors cannot be read.
    #[error("the schema cannot be read: {reason}")]
    Schema {
        /// Why.
        reason: String,
    },
}

/// A payload is not a message of the gate's type.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("this {length}-byte payload is not {expected}: {}{reason}", place(path, *offset))]
#[non_exhaustive]
pub struct DecodeError {
    /// The length of the payload.
    pub length: usize,
    /// What it should be: `` a protobuf message `rover.Measurement` ``.
    pub expected: String,
    /// The path in the message; empty at the top, and if the codec does not report it.
    pub path: String,
    /// The number of bytes before the mistake, if the codec reports it.
    pub offset: Option<usize>,
    /// What is wrong.
    pub reason: String,
}

fn place(path: &str, offset: Option<usize>) -> String {
    match (path, offset) {
        ("", None) => String::new(),
        ("", Some(offset)) => format!("at byte {offset}: "),
        (path, None) => format!("field `{path}`: "),
        (path, Some(offset)) => format!("field `{path}` at byte {offset}: "),
    }
}

/// A value, a field or a condition does not fit the messages of a type.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}{reason}", place(path, None))]
#[non_exhaustive]
pub struct Mismatch {
    /// The field: `pose.joints[2]`; empty for the message itself.
    pub path: String,
    /// What is wrong with it.
    pub reason: String,
    /// What to do.
    pub help: Option<String>,
    /// What would be right.
    pub note: Option<String>,
}

impl Mismatch {
    pub(crate) fn new(reason: impl Into<String>) -> Self {
        Self { path: String::new(), reason: reason.into(), help: None, note: None }
    }

    pub(crate) fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Suggests the one of `names` that `wrong` probably means, if one is near enough.
    pub(crate) fn did_you_mean<'n>(self, wrong: &str, names: impl IntoIterator<Item = &'n str>) -> Self {
        match closest_name(wrong, names) {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    pub(crate) fn note(mut self, text: impl Into<String>) -> Self {
        self.note = Some(text.into());
        self
    }

    /// Turns the error into one of the containing value, by putting `segment` (`field` or `[2]`) before the path.
    pub(crate) fn below(mut self, segment: &str) -> Self {
        let rest = if self.path.starts_with('[') || self.path.is_empty() { "" } else { "." };
        self.path = format!("{segment}{rest}{}", self.path);
        self
    }
}

impl From<Mismatch> for Problem {
    fn from(error: Mismatch) -> Self {
        let problem = error.help.iter().fold(Problem::new(error.to_string()), Problem::help);
        error.note.iter().fold(problem, Problem::note)
    }
}
