//! Finds what is wrong with the files of a host, before they fail in the middle of a handshake on another host.

use super::HostFiles;
use super::certificate::Certificate;
use crate::deployment::Host;
use rcgen::KeyPair;
use rustls_pki_types::UnixTime;
use std::fs;
use std::io;
use std::net::IpAddr;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use webpki::{ALL_VERIFICATION_ALGS, EndEntityCert, KeyUsage, anchor_from_trusted_cert};

/// What is wrong with a file of a host.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum KeyProblem {
    /// There is no folder for the host.
    #[error("host `{host}` has no certificate: there is no folder `{}`", folder.display())]
    NoFolder { host: String, folder: PathBuf },
    /// A file is missing.
    #[error("a file of host `{host}` is missing: `{}`", path.display())]
    Missing { host: String, path: PathBuf },
    /// A file cannot be read.
    #[error("cannot read `{}`", path.display())]
    Unreadable { path: PathBuf, source: io::Error },
    /// A file does not contain what its name says.
    #[error("`{}` is not a {expected} in PEM", path.display())]
    Malformed { path: PathBuf, expected: &'static str },
    /// Users other than its owner may access the private key.
    #[error("the private key `{}` can be read by others, its mode is {mode:04o}", path.display())]
    Exposed { path: PathBuf, mode: u32 },
    /// The private key does not belong to the certificate.
    #[error("the private key `{}` does not belong to the certificate beside it", path.display())]
    OtherKey { path: PathBuf },
    /// The certificate has expired.
    #[error("the certificate of host `{host}` expired on {}", scl_terminal::timestamp(*at))]
    Expired { host: String, at: SystemTime },
    /// The certificate is not valid yet.
    #[error("the certificate of host `{host}` is not valid before {}, and the clock says {}", scl_terminal::timestamp(*from), scl_terminal::timestamp(*now))]
    NotYetValid { host: String, from: SystemTime, now: SystemTime },
    /// Another authority signed the certificate.
    #[error("the certificate of host `{host}` was not signed by the authority `{}`", authority.display())]
    Foreign { host: String, authority: PathBuf },
    /// The library rejects the certificate for another reason.
    #[error("the certificate of host `{host}` cannot be used: {reason}")]
    Unusable { host: String, reason: webpki::Error },
    /// The certificate is for another host.
    #[error("the certificate in `{}` is for host `{found}`, not for `{host}`", path.display())]
    OtherHost { host: String, found: String, path: PathBuf },
    /// The certificate is not for the address in the launch file.
    #[error("the certificate of host `{host}` is for the address {}, not for `{address}`", quoted(found))]
    OtherAddress { host: String, address: String, found: Vec<String> },
}

/// Checks the files of a host, and returns when its certificate expires.
///
/// # Errors
///
/// Returns all problems.
pub fn check(files: &HostFiles, host: &Host, now: SystemTime) -> Result<SystemTime, Vec<KeyProblem>> {
    let name = host.name.clone();
    if let Some(folder) = files.key.parent().filter(|folder| !folder.is_dir()) {
        return Err(vec![KeyProblem::NoFolder { host: name, folder: folder.to_owned() }]);
    }
    let mut problems = Vec::new();
    let [authority, certificate, key] = [&files.authority, &files.certificate, &files.key]
        .map(|path| read(path, &name).map_err(|problem| problems.push(problem)).ok());
    let mut parsed = |text: Option<String>, path: &Path| {
        let read = text.as_deref().map(Certificate::read)?;
        if read.is_none() {
            problems.push(KeyProblem::Malformed { path: path.to_owned(), expected: "certificate" });
        }
        read
    };
    let authority = parsed(authority, &files.authority);
    let certificate = parsed(certificate, &files.certificate);
    let key = key.and_then(|text| {
        problems.extend(check_mode(&files.key));
        let malformed = |_| KeyProblem::Malformed { path: files.key.clone(), expected: "private key" };
        KeyPair::from_pem(&text).map_err(malformed).map_err(|problem| problems.push(problem)).ok()
    });
    let Some(certificate) = certificate else { return Err(problems) };
    if key.is_some_and(|key| key.public_key_raw() != certificate.public_key) {
        problems.push(KeyProblem::OtherKey { path: files.key.clone() });
    }
    problems.extend(check_times(&certificate, &name, now));
    problems.extend(check_names(&certificate, host, files));
    if let Some(authority) = authority {
        problems.extend(check_signature(&certificate, &authority, &name, files));
    }
    if problems.is_empty() { Ok(certificate.not_after) } else { Err(problems) }
}

fn read(path: &Path, host: &str) -> Result<String, KeyProblem> {
    fs::read_to_string(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => KeyProblem::Missing { host: host.to_owned(), path: path.to_owned() },
        io::ErrorKind::InvalidData => KeyProblem::Malformed { path: path.to_owned(), expected: "text" },
        _ => KeyProblem::Unreadable { path: path.to_owned(), source },
    })
}

fn check_mode(path: &Path) -> Option<KeyProblem> {
    let mode = fs::metadata(path).ok()?.permissions().mode() & 0o7777;
    (mode & 0o077 != 0).then(|| KeyProblem::Exposed { path: path.to_owned(), mode })
}

fn check_times(certificate: &Certificate, host: &str, now: SystemTime) -> Option<KeyProblem> {
    let host = host.to_owned();
    if now > certificate.not_after {
        return Some(KeyProblem::Expired { host, at: certificate.not_after });
    }
    let from = certificate.not_before;
    (now < from).then_some(KeyProblem::NotYetValid { host, from, now })
}

/// Checks the names in the certificate: other hosts identify this one by the common name, and expect its address among
/// the alternative names.
fn check_names(certificate: &Certificate, host: &Host, files: &HostFiles) -> Vec<KeyProblem> {
    if certificate.name != host.name {
        let (found, path) = (certificate.name.clone(), files.certificate.clone());
        return vec![KeyProblem::OtherHost { host: host.name.clone(), found, path }];
    }
    let address = host.address.parse::<IpAddr>().map_or_else(|_| host.address.clone(), |address| address.to_string());
    if certificate.addresses.iter().any(|found| found.eq_ignore_ascii_case(&address)) {
        return Vec::new();
    }
    let found = certificate.addresses.clone();
    vec![KeyProblem::OtherAddress { host: host.name.clone(), address: host.address.clone(), found }]
}

/// Verifies the certificate with the library that also verifies it in handshakes, at a time when it has not expired.
fn check_signature(
    certificate: &Certificate,
    authority: &Certificate,
    host: &str,
    files: &HostFiles,
) -> Option<KeyProblem> {
    let verdict = || {
        let anchors = [anchor_from_trusted_cert(&authority.der)?];
        let valid = certificate.not_before.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let time = UnixTime::since_unix_epoch(valid + Duration::from_secs(1));
        let certificate = EndEntityCert::try_from(&certificate.der)?;
        for usage in [KeyUsage::server_auth(), KeyUsage::client_auth()] {
            certificate.verify_for_usage(ALL_VERIFICATION_ALGS, &anchors, &[], time, usage, None, None)?;
        }
        Ok(())
    };
    let host = host.to_owned();
    match verdict() {
        Ok(()) => None,
        Err(webpki::Error::UnknownIssuer | webpki::Error::InvalidSignatureForPublicKey) => {
            Some(KeyProblem::Foreign { host, authority: files.authority.clone() })
        }
        Err(reason) => Some(KeyProblem::Unusable { host, reason }),
    }
}

fn quoted(names: &[String]) -> String {
    match names {
        [] => "of nobody".to_owned(),
        names => scl_terminal::quoted_list(names.iter().map(String::as_str)),
    }
}
