//! Makes the authority of a system and the certificates of its hosts.

use super::certificate::Certificate;
use super::{AUTHORITY_CERTIFICATE, CERTIFICATE, KEY};
use crate::deployment::{Deployment, Host};
use rcgen::{
    BasicConstraints, CertificateParams, DistinguishedName, DnType, ExtendedKeyUsagePurpose, IsCa, Issuer, KeyPair,
    KeyUsagePurpose,
};
use std::fs::{self, DirBuilder, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Clocks of hosts may differ, so certificates are valid from some time before now.
const EARLIER: Duration = Duration::from_secs(24 * 3600);

/// Minimum validity of the authority's certificate: the lifetime of a system, whose hosts get new certificates from it.
const AUTHORITY_DAYS: u32 = 30 * 365;

/// What [`issue`] is to make.
#[derive(Debug)]
pub struct Wanted<'a> {
    /// The name of the system.
    pub system: &'a str,
    /// The hosts that need a certificate.
    pub hosts: Vec<&'a Host>,
    /// How long their certificates are valid.
    pub days: u32,
    /// Whether existing certificates of these hosts are replaced. Certificates of other hosts stay valid.
    pub replace_hosts: bool,
    /// Whether an existing authority is replaced, which makes all earlier certificates invalid.
    pub replace_authority: bool,
    /// The time from which the days count.
    pub now: SystemTime,
}

/// What [`issue`] did for the authority or for a host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Issued {
    /// The host; `None` for the authority.
    pub host: Option<String>,
    /// Its folder.
    pub folder: PathBuf,
    /// Whether the certificate was made now; otherwise it existed already.
    pub is_new: bool,
    /// When the certificate expires; `None` if it cannot be read.
    pub expires: Option<SystemTime>,
}

/// Error of [`issue`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum KeysError {
    /// A file or folder cannot be written or read.
    #[error("cannot write `{}`", path.display())]
    Write { path: PathBuf, source: io::Error },
    /// The key of the authority is missing; only its certificate exists.
    #[error("the key of the authority is missing: `{}`", path.display())]
    NoAuthorityKey { path: PathBuf },
    /// The authority has expired, so a new certificate would never be valid.
    #[error("the authority in `{}` expired on {}", folder.display(), scl_terminal::timestamp(*at))]
    AuthorityExpired { folder: PathBuf, at: SystemTime },
    /// The files of the authority are damaged.
    #[error("cannot use the authority in `{}`: {reason}", folder.display())]
    Authority { folder: PathBuf, reason: String },
    /// The library failed to make a certificate.
    #[error("cannot make a certificate for `{host}`")]
    Certificate { host: String, source: rcgen::Error },
}

/// Makes the authority and the certificates of the hosts. Existing ones are kept unless they are to be replaced.
///
/// # Errors
///
/// See [`KeysError`]. Certificates that were made before the error stay.
pub fn issue(certificates: &Path, wanted: &Wanted<'_>) -> Result<Vec<Issued>, KeysError> {
    let write = |path: &Path| {
        let path = path.to_owned();
        move |source| KeysError::Write { path, source }
    };
    create_folder(certificates).map_err(write(certificates))?;
    let own = certificates.join(Deployment::AUTHORITY);
    let is_new = wanted.replace_authority || !own.exists();
    if is_new {
        let (certificate, key) = new_authority(wanted)?;
        replace_folder(&own, &[(CERTIFICATE, &certificate), (KEY, &key)]).map_err(write(&own))?;
    }
    let authority = Authority::read(&own)?;
    let mut issued = vec![Issued { host: None, expires: Some(authority.expires), folder: own, is_new }];
    for host in &wanted.hosts {
        let folder = certificates.join(&host.name);
        let is_new = wanted.replace_hosts || !folder.exists();
        if is_new {
            if authority.expires <= wanted.now {
                return Err(KeysError::AuthorityExpired { folder: issued.remove(0).folder, at: authority.expires });
            }
            let (certificate, key) = authority.certify(host, wanted)?;
            let files = [(AUTHORITY_CERTIFICATE, authority.pem.as_str()), (CERTIFICATE, &certificate), (KEY, &key)];
            replace_folder(&folder, &files).map_err(write(&folder))?;
        }
        let text = fs::read_to_string(folder.join(CERTIFICATE)).unwrap_or_default();
        let expires = Certificate::read(&text).map(|it| it.not_after);
        issued.push(Issued { host: Some(host.name.clone()), folder, is_new, expires });
    }
    Ok(issued)
}

/// The authority in use.
struct Authority {
    pem: String,
    issuer: Issuer<'static, KeyPair>,
    expires: SystemTime,
}

impl Authority {
    fn read(folder: &Path) -> Result<Self, KeysError> {
        let damaged = |reason: &str| KeysError::Authority { folder: folder.to_owned(), reason: reason.to_owned() };
        let read = |name: &str| {
            let text = fs::read_to_string(folder.join(name));
            text.map_err(|error| damaged(&format!("`{name}`: {error}")))
        };
        let pem = read(CERTIFICATE)?;
        let key = folder.join(KEY);
        if !key.exists() {
            return Err(KeysError::NoAuthorityKey { path: key });
        }
        let key = KeyPair::from_pem(&read(KEY)?).map_err(|_| damaged("`key.pem` is not a private key in PEM"))?;
        let certificate =
            Certificate::read(&pem).ok_or_else(|| damaged("`certificate.pem` is not a certificate in PEM"))?;
        if certificate.public_key != key.public_key_raw() {
            return Err(damaged("its key does not belong to its certificate"));
        }
        // The library needs only these parameters, which `new_authority` derives from the name in the same way.
        let issuer = Issuer::new(authority_params(&certificate.name), key);
        Ok(Self { pem, issuer, expires: certificate.not_after })
    }

    fn certify(&self, host: &Host, wanted: &Wanted<'_>) -> Result<(String, String), KeysError> {
        let failed = |source| KeysError::Certificate { host: host.name.clone(), source };
        let mut params = CertificateParams::new(vec![host.address.clone()]).map_err(failed)?;
        params.distinguished_name = common_name(&host.name);
        params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
        params.extended_key_usages = vec![ExtendedKeyUsagePurpose::ServerAuth, ExtendedKeyUsagePurpose::ClientAuth];
        params.use_authority_key_identifier_extension = true;
        let expires = (wanted.now + days(wanted.days)).min(self.expires);
        set_validity(&mut params, wanted.now, expires);
        let key = KeyPair::generate().map_err(failed)?;
        let certificate = params.signed_by(&key, &self.issuer).map_err(failed)?;
        Ok((certificate.pem(), key.serialize_pem()))
    }
}

fn new_authority(wanted: &Wanted<'_>) -> Result<(String, String), KeysError> {
    let failed = |source| KeysError::Certificate { host: "authority".to_owned(), source };
    let key = KeyPair::generate().map_err(failed)?;
    // Each authority has a unique name, so that a host that trusts a different one can say so.
    let identifier = CertificateParams::default().key_identifier(&key);
    let identifier: String = identifier.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
    let mut params = authority_params(&format!("SCL system {} {identifier}", wanted.system));
    set_validity(&mut params, wanted.now, wanted.now + days(wanted.days.max(AUTHORITY_DAYS)));
    let certificate = params.self_signed(&key).map_err(failed)?;
    Ok((certificate.pem(), key.serialize_pem()))
}

fn authority_params(name: &str) -> CertificateParams {
    let mut params = CertificateParams::default();
    params.distinguished_name = common_name(name);
    // It may sign certificates of hosts, but not of other authorities.
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign];
    params
}

fn common_name(name: &str) -> DistinguishedName {
    let mut names = DistinguishedName::new();
    names.push(DnType::CommonName, name);
    names
}

fn set_validity(params: &mut CertificateParams, now: SystemTime, expires: SystemTime) {
    let epoch = rcgen::date_time_ymd(1970, 1, 1);
    let since_epoch = |time: SystemTime| time.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    params.not_before = epoch + since_epoch(now).saturating_sub(EARLIER);
    params.not_after = epoch + since_epoch(expires);
}

fn days(days: u32) -> Duration {
    Duration::from_secs(u64::from(days) * 24 * 3600)
}

/// Creates a folder and its missing parents with mode 0700.
fn create_folder(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(folder)
}

/// Writes a folder of files with mode 0600, replacing an existing folder.
///
/// The folder is written under another name and then renamed: a full disk leaves no truncated key, and the old folder
/// stays until the new one is complete.
fn replace_folder(folder: &Path, files: &[(&str, &str)]) -> io::Result<()> {
    // This temporary folder is removed on return, together with the replaced one inside it.
    let beside = tempfile::Builder::new().prefix(".").tempdir_in(folder.parent().unwrap_or(folder))?;
    let (new, old) = (beside.path().join("new"), beside.path().join("old"));
    create_folder(&new)?;
    for (name, text) in files {
        let mut file = OpenOptions::new().write(true).create_new(true).mode(0o600).open(new.join(name))?;
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
    }
    match fs::rename(folder, &old) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => fs::rename(&new, folder).inspect_err(|_| _ = fs::rename(&old, folder)),
    }
}
