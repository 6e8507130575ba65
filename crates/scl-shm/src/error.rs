//! What can go wrong, one enum per operation.

use std::io;
use std::path::PathBuf;

/// Shared memory cannot be used in a folder or for a connection.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShmError {
    /// A file could not be created, opened or locked.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// A thread could not be started.
    #[error("cannot start the thread that cleans up after killed programs")]
    Thread {
        /// The cause.
        source: io::Error,
    },
    /// iceoryx2 cannot express the folder's path.
    #[error("{} is too long for shared memory, which allows 160 bytes; choose a shorter `SCL_RUNTIME_DIR`", path.display())]
    Path {
        /// The folder.
        path: PathBuf,
    },
    /// Another user has created a file with this system's prefix.
    #[error("{} belongs to user {owner}; remove it as that user or as root", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Its owner.
        owner: u32,
    },
    /// An operation of iceoryx2 failed.
    #[error("iceoryx2 cannot {action}: {reason}")]
    Engine {
        /// What was tried.
        action: &'static str,
        /// The engine's name for the error.
        reason: String,
    },
    /// The service has settings that no SCL end chooses.
    #[error("the peer's service has {what}")]
    Settings {
        /// What is wrong with it.
        what: &'static str,
    },
    /// There is too little shared memory for the connection's own files.
    #[error(transparent)]
    TooLittle(#[from] crate::TooLittle),
}

impl ShmError {
    pub(crate) fn engine(action: &'static str, error: impl std::fmt::Debug) -> Self {
        Self::Engine { action, reason: format!("{error:?}") }
    }
}

/// No memory can be lent now; the message can be sent in another way.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LoanError {
    /// As much is lent as the connection allows.
    #[error("all loans of the connection are in use")]
    TooMany,
    /// Writing to more memory would end the program with SIGBUS.
    #[error(transparent)]
    TooLittle(#[from] crate::TooLittle),
    /// The engine has failed.
    #[error("iceoryx2 cannot lend memory: {0}")]
    Engine(String),
}

/// A sample could not be sent, and is gone. The connection is of no further use.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SendError {
    /// The receiving port has gone.
    #[error("the receiving end has closed its port")]
    NoReceiver,
    /// The engine has failed.
    #[error("iceoryx2 cannot send a sample: {0}")]
    Engine(String),
}

/// An announced sample could not be received. The connection is of no further use.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReceiveError {
    /// There is no sample.
    #[error("the announced sample is not there: the peer did not send it, or this program cannot map more memory")]
    Missing,
    /// The sample has another length than announced.
    #[error("the peer announced a sample of {announced} bytes and sent one of {sent}")]
    Length {
        /// The announced length.
        announced: u64,
        /// The length of the sample.
        sent: u64,
    },
    /// The engine has failed.
    #[error("iceoryx2 cannot receive a sample: {0}")]
    Engine(String),
}
