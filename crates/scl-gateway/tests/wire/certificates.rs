//! Certificates for tests: good, and wrong in one way each.

use std::path::Path;

use rcgen::{BasicConstraints, CertificateParams, CertifiedIssuer, DnType, ExtendedKeyUsagePurpose, IsCa, KeyPair};
use scl_gateway::keys::HostFiles;

pub(super) struct Authority(CertifiedIssuer<'static, KeyPair>);

impl Authority {
    pub(super) fn new() -> Authority {
        let mut params = CertificateParams::new(Vec::new()).expect("no names");
        params.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
        params.distinguished_name.push(DnType::CommonName, "authority");
        let key = KeyPair::generate().expect("a key");
        Authority(CertifiedIssuer::self_signed(params, key).expect("an authority"))
    }

    /// Writes the files of a host whose address is `127.0.0.1`.
    pub(super) fn host(&self, folder: &Path, host: &str) -> HostFiles {
        self.host_with(folder, host, "127.0.0.1", |_| ())
    }

    /// The same for another address, and with changes.
    pub(super) fn host_with(
        &self,
        folder: &Path,
        host: &str,
        address: &str,
        change: impl FnOnce(&mut CertificateParams),
    ) -> HostFiles {
        let mut params = CertificateParams::new([address.to_owned()]).expect("a name");
        params.distinguished_name.push(DnType::CommonName, host);
        params.extended_key_usages = vec![ExtendedKeyUsagePurpose::ServerAuth, ExtendedKeyUsagePurpose::ClientAuth];
        change(&mut params);
        let key = KeyPair::generate().expect("a key");
        let certificate = params.signed_by(&key, &self.0).expect("a certificate");
        let write = |name: &str, text: String| {
            let path = folder.join(format!("{host}-{name}.pem"));
            std::fs::write(&path, text).expect("cannot write");
            path
        };
        HostFiles {
            authority: write("authority", self.0.as_ref().pem()),
            certificate: write("certificate", certificate.pem()),
            key: write("key", key.serialize_pem()),
        }
    }
}
