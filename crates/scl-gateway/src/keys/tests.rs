//! Certificates that are made are good; each way of spoiling them is named.

use super::*;
use crate::deployment::Host;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

const DAY: Duration = Duration::from_secs(24 * 3600);

fn host(name: &str, address: &str) -> Host {
    Host { name: name.to_owned(), address: address.to_owned(), port: 7447, components: Vec::new() }
}

/// The time of all tests, to the second, as certificates have it.
fn now() -> SystemTime {
    SystemTime::UNIX_EPOCH + 20_000 * DAY
}

/// A folder with the certificates of hosts.
struct Keys {
    folder: TempDir,
    hosts: Vec<Host>,
}

impl Keys {
    fn made(hosts: &[(&str, &str)]) -> Self {
        let hosts = hosts.iter().map(|(name, address)| host(name, address)).collect();
        let keys = Self { folder: tempfile::tempdir().unwrap(), hosts };
        keys.issue(false, false);
        keys
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("keys").join(name)
    }

    fn issue(&self, replace_hosts: bool, replace_authority: bool) -> Vec<Issued> {
        let hosts = self.hosts.iter().collect();
        let wanted = Wanted { system: "rover", hosts, days: 30, replace_hosts, replace_authority, now: now() };
        issue(&self.path(""), &wanted).unwrap()
    }

    fn files(&self, host: &str) -> HostFiles {
        HostFiles::of(&self.path(""), host)
    }

    fn check_at(&self, host: &Host, time: SystemTime) -> Result<SystemTime, Vec<String>> {
        let problems = |problems: Vec<KeyProblem>| problems.iter().map(ToString::to_string).collect::<Vec<_>>();
        let folder = self.folder.path().display().to_string();
        let shown = |texts: Vec<String>| texts.into_iter().map(|text| text.replace(&folder, "FOLDER")).collect();
        check(&self.files(&host.name), host, time).map_err(problems).map_err(shown)
    }

    #[track_caller]
    fn expect(&self, host: &Host, time: SystemTime, expected: &[&str]) {
        let found = self.check_at(host, time).err().unwrap_or_default();
        assert_eq!(found, expected);
    }
}

const HOSTS: [(&str, &str); 4] =
    [("board", "192.0.2.10"), ("ground", "ground.example"), ("six", "2001:DB8::10"), ("local", "127.0.0.1")];

#[test]
fn what_is_made_is_valid_for_the_days_asked_for_and_secret() {
    let keys = Keys::made(&HOSTS);
    for host in &keys.hosts {
        assert_eq!(keys.check_at(host, now()), Ok(now() + 30 * DAY), "{}", host.name);
        // Clocks of hosts may be some hours apart.
        assert!(keys.check_at(host, now() - DAY / 2).is_ok());
    }
    let mode = |path: PathBuf| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    assert_eq!(["", "authority", "board"].map(|name| mode(keys.path(name))), [0o700; 3]);
    let files = ["authority/certificate.pem", "authority/key.pem", "board/authority.pem", "board/certificate.pem"];
    assert_eq!(files.map(|name| mode(keys.path(name))), [0o600; 4]);
    assert_eq!(mode(keys.path("board/key.pem")), 0o600);
    assert_eq!(fs::read_dir(keys.path("board")).unwrap().count(), 3, "the key of the authority is not among them");
}

#[test]
fn a_host_can_be_added_and_nothing_is_overwritten() {
    let mut keys = Keys::made(&HOSTS[..1]);
    let before = fs::read(keys.path("board/key.pem")).unwrap();
    keys.hosts.push(host("late", "192.0.2.99"));
    let issued = keys.issue(false, false);
    let new: Vec<bool> = issued.iter().map(|it| it.is_new).collect();
    assert_eq!(new, [false, false, true]);
    assert_eq!(fs::read(keys.path("board/key.pem")).unwrap(), before);
    for host in &keys.hosts {
        assert!(keys.check_at(host, now()).is_ok(), "{}", host.name);
    }
    let authority = |host: &str| fs::read(keys.files(host).authority).unwrap();
    assert_eq!(authority("board"), authority("late"));
}

#[test]
fn a_replaced_host_is_known_to_the_others_until_the_authority_is_replaced() {
    let keys = Keys::made(&HOSTS[..2]);
    let (board, ground) = (&keys.hosts[0], &keys.hosts[1]);
    let old_authority = fs::read(keys.files("ground").authority).unwrap();
    let old_key = fs::read(keys.path("board/key.pem")).unwrap();
    keys.issue(true, false);
    assert_ne!(fs::read(keys.path("board/key.pem")).unwrap(), old_key);
    assert_eq!(fs::read(keys.files("ground").authority).unwrap(), old_authority);
    keys.issue(true, true);
    assert!(keys.check_at(board, now()).is_ok());
    fs::write(keys.files("ground").authority, old_authority).unwrap();
    keys.expect(
        ground,
        now(),
        &["the certificate of host `ground` was not signed by the authority `FOLDER/keys/ground/authority.pem`"],
    );
}

#[test]
fn a_host_never_outlives_its_authority() {
    let keys = Keys::made(&HOSTS[..1]);
    let later = now() + 10_940 * DAY;
    let wanted = Wanted {
        system: "rover",
        hosts: keys.hosts.iter().collect(),
        days: 30,
        replace_hosts: true,
        replace_authority: false,
        now: later,
    };
    let issued = issue(&keys.path(""), &wanted).unwrap();
    assert_eq!(issued[1].expires, Some(now() + 10_950 * DAY));
    let error = issue(&keys.path(""), &Wanted { now: now() + 10_951 * DAY, ..wanted }).unwrap_err();
    assert!(matches!(error, KeysError::AuthorityExpired { .. }), "{error}");
    assert!(keys.check_at(&keys.hosts[0], later).is_ok(), "the certificate that was there stays");
}

#[test]
fn times_are_checked() {
    let keys = Keys::made(&HOSTS[..1]);
    keys.expect(
        &keys.hosts[0],
        now() + 31 * DAY,
        &["the certificate of host `board` expired on 2024-11-03T00:00:00.000Z"],
    );
    keys.expect(
        &keys.hosts[0],
        now() - 2 * DAY,
        &["the certificate of host `board` is not valid before 2024-10-03T00:00:00.000Z, and the clock says \
           2024-10-02T00:00:00.000Z"],
    );
}

#[test]
fn missing_files_and_folders_are_named() {
    let keys = Keys::made(&HOSTS[..1]);
    let spare = host("spare", "192.0.2.1");
    keys.expect(&spare, now(), &["host `spare` has no certificate: there is no folder `FOLDER/keys/spare`"]);
    fs::remove_file(keys.files("board").key).unwrap();
    fs::remove_file(keys.files("board").authority).unwrap();
    keys.expect(
        &keys.hosts[0],
        now(),
        &[
            "a file of host `board` is missing: `FOLDER/keys/board/authority.pem`",
            "a file of host `board` is missing: `FOLDER/keys/board/key.pem`",
        ],
    );
}

#[test]
fn every_mistake_of_one_host_is_found() {
    let keys = Keys::made(&HOSTS[..2]);
    let files = keys.files("board");
    fs::set_permissions(&files.key, PermissionsExt::from_mode(0o644)).unwrap();
    keys.expect(
        &keys.hosts[0],
        now(),
        &["the private key `FOLDER/keys/board/key.pem` can be read by others, its mode is 0644"],
    );
    fs::copy(keys.files("ground").certificate, &files.certificate).unwrap();
    keys.expect(
        &keys.hosts[0],
        now(),
        &[
            "the private key `FOLDER/keys/board/key.pem` can be read by others, its mode is 0644",
            "the private key `FOLDER/keys/board/key.pem` does not belong to the certificate beside it",
            "the certificate in `FOLDER/keys/board/certificate.pem` is for host `ground`, not for `board`",
        ],
    );
    fs::write(&files.authority, "nothing").unwrap();
    fs::write(&files.certificate, "-----BEGIN CERTIFICATE-----\nMIIB\n-----END CERTIFICATE-----\n").unwrap();
    fs::remove_file(&files.key).unwrap();
    fs::write(&files.key, [0xff]).unwrap();
    keys.expect(
        &keys.hosts[0],
        now(),
        &[
            "`FOLDER/keys/board/key.pem` is not a text in PEM",
            "`FOLDER/keys/board/authority.pem` is not a certificate in PEM",
            "`FOLDER/keys/board/certificate.pem` is not a certificate in PEM",
        ],
    );
}

#[test]
fn another_address_needs_another_certificate() {
    let keys = Keys::made(&HOSTS[..1]);
    keys.expect(
        &host("board", "192.0.2.11"),
        now(),
        &["the certificate of host `board` is for the address `192.0.2.10`, not for `192.0.2.11`"],
    );
}

#[test]
fn a_system_has_its_own_authority() {
    let (keys, other) = (Keys::made(&HOSTS[..1]), Keys::made(&HOSTS[..1]));
    fs::copy(other.files("board").authority, keys.files("board").authority).unwrap();
    let found = keys.check_at(&keys.hosts[0], now()).unwrap_err();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("was not signed by the authority"), "{found:?}");
}

#[test]
fn without_the_key_of_the_authority_nothing_is_signed() {
    let mut keys = Keys::made(&HOSTS[..1]);
    fs::remove_file(keys.path("authority/key.pem")).unwrap();
    keys.hosts.push(host("late", "192.0.2.99"));
    let hosts = keys.hosts.iter().collect();
    let wanted =
        Wanted { system: "rover", hosts, days: 30, replace_hosts: false, replace_authority: false, now: now() };
    let error = issue(&keys.path(""), &wanted).unwrap_err();
    assert!(matches!(error, KeysError::NoAuthorityKey { .. }), "{error}");
    assert!(!keys.path("late").exists());
}
