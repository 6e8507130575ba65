//! Certificates, by which the gateways of a system authenticate each other and refuse all others.
//!
//! ```text
//! keys/authority/certificate.pem, key.pem                  stay where they were made: they sign certificates
//! keys/<host>/authority.pem, certificate.pem, key.pem      are copied to that host
//! ```
//!
//! The common name of a host's certificate is the host's name, and its subject alternative name is the host's address.

mod certificate;
mod check;
mod issue;

pub use check::{KeyProblem, check};
pub use issue::{Issued, KeysError, Wanted, issue};

use std::path::{Path, PathBuf};

/// The PEM files of one host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HostFiles {
    /// Certificate of the authority that signed the certificates of all hosts.
    pub authority: PathBuf,
    /// The host's certificate, for server and client: the common name is the host's name, the alternative names are its
    /// addresses.
    pub certificate: PathBuf,
    /// Its private key.
    pub key: PathBuf,
}

impl HostFiles {
    /// Returns the paths of a host's files in the folder of the certificates.
    pub fn of(certificates: &Path, host: &str) -> Self {
        let folder = certificates.join(host);
        Self {
            authority: folder.join(AUTHORITY_CERTIFICATE),
            certificate: folder.join(CERTIFICATE),
            key: folder.join(KEY),
        }
    }
}

const AUTHORITY_CERTIFICATE: &str = "authority.pem";
const CERTIFICATE: &str = "certificate.pem";
const KEY: &str = "key.pem";

#[cfg(test)]
mod tests;
