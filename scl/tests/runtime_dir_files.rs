//! Sockets, addresses and announcements in the folder of a system.
#![allow(clippy::unwrap_used)]

use std::{
    fs,
    io::{Read, Write},
    net::TcpStream,
    os::unix::{
        fs::{FileTypeExt, MetadataExt, symlink},
        net::{UnixListener, UnixStream},
    },
    path::Path,
    time::{Duration, SystemTime},
};

use rustix::fs::{CWD, FileType, Mode, mknodat};
use scl::runtime_dir::internals::{Address, ComponentLock, bind_ipc, bind_tcp, find};
use scl::runtime_dir::{AnnouncedEndpoint, Announcement, RuntimeDir, RuntimeDirError, SystemDir};
use tempfile::TempDir;

const ENDPOINT: &str = "sensor.measurements--controller.sensor.1a2b3c4d";

fn rover() -> (TempDir, SystemDir) {
    let root = tempfile::tempdir().unwrap();
    let system = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| root.path().into())).unwrap();
    let dir = system.system("rover").unwrap();
    (root, dir)
}

fn names(dir: &SystemDir) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(dir.folder()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn set_age(path: &Path, seconds: u64) {
    let time = SystemTime::now() - Duration::from_secs(seconds);
    fs::File::options().append(true).open(path).unwrap().set_modified(time).unwrap();
}

fn check_connected(mut from: impl Write, mut at: impl Read) {
    from.write_all(b"hello").unwrap();
    drop(from);
    let mut text = String::new();
    at.read_to_string(&mut text).unwrap();
    assert_eq!(text, "hello");
}

#[test]
fn a_socket_is_private_and_removed_with_its_guard() {
    let (_root, dir) = rover();
    assert_eq!(find(&dir, ENDPOINT), None);
    let bound = bind_ipc(&dir, ENDPOINT).unwrap();
    let path = dir.folder().join(ENDPOINT);
    assert_eq!(find(&dir, ENDPOINT), Some(Address::Ipc(path.clone())));
    assert_eq!(fs::metadata(&path).unwrap().mode() & 0o7777, 0o600);
    assert_eq!(names(&dir), [ENDPOINT]);
    assert_eq!(bound.listener.accept().unwrap_err().kind(), std::io::ErrorKind::WouldBlock);

    let peer = UnixStream::connect(&path).unwrap();
    let (accepted, _) = bound.listener.accept().unwrap();
    check_connected(peer, accepted);

    drop(bound);
    assert!(names(&dir).is_empty());
}

#[test]
fn a_stale_socket_a_link_and_a_file_are_replaced() {
    let (root, dir) = rover();
    let path = dir.folder().join(ENDPOINT);
    let victim = root.path().join("victim");
    fs::write(&victim, "untouched").unwrap();
    let leftovers: [&dyn Fn(); 3] =
        [&|| drop(UnixListener::bind(&path).unwrap()), &|| symlink(&victim, &path).unwrap(), &|| {
            fs::write(&path, "x").unwrap()
        }];
    for leave in leftovers {
        leave();
        let bound = bind_ipc(&dir, ENDPOINT).unwrap();
        assert!(fs::symlink_metadata(&path).unwrap().file_type().is_socket());
        UnixStream::connect(&path).unwrap();
        drop(bound);
        assert!(names(&dir).is_empty());
    }
    assert_eq!(fs::read_to_string(victim).unwrap(), "untouched");
}

#[test]
fn a_guard_does_not_remove_what_replaced_its_file() {
    let (_root, dir) = rover();
    let first = bind_ipc(&dir, ENDPOINT).unwrap();
    let second = bind_ipc(&dir, ENDPOINT).unwrap();
    assert!(!first.guard.is_ours() && second.guard.is_ours());
    drop(first);
    UnixStream::connect(second.guard.path()).unwrap();

    let first = bind_tcp(&dir, ENDPOINT).unwrap();
    let second = bind_tcp(&dir, ENDPOINT).unwrap();
    // Many file systems give a freed inode number to the next file, which must not be mistaken for the first.
    let third = bind_tcp(&dir, ENDPOINT).unwrap();
    drop((first, second));
    assert!(third.guard.is_ours());
}

#[test]
fn a_failed_bind_leaves_nothing_behind() {
    let (_root, dir) = rover();
    fs::create_dir(dir.folder().join(ENDPOINT)).unwrap();
    let error = bind_ipc(&dir, ENDPOINT).unwrap_err();
    assert!(error.to_string().starts_with("cannot replace `"), "{error}");
    assert_eq!(names(&dir), [ENDPOINT]);
}

#[test]
fn a_removed_folder_is_a_clear_error() {
    let (_root, dir) = rover();
    let bound = bind_ipc(&dir, ENDPOINT).unwrap();
    fs::remove_dir_all(dir.folder()).unwrap();
    drop(bound);
    let errors = [
        bind_ipc(&dir, ENDPOINT).unwrap_err(),
        bind_tcp(&dir, ENDPOINT).unwrap_err(),
        ComponentLock::take(&dir, "sensor").unwrap_err(),
        Announcement::of_this_process("sensor").publish(&dir).unwrap_err(),
    ];
    for error in errors {
        let text = error.to_string();
        assert!(
            text.starts_with("cannot ") && text.contains("help: its folder does not exist or was removed"),
            "{text}"
        );
        assert!(std::error::Error::source(&error).is_some());
    }
    assert_eq!(find(&dir, ENDPOINT), None);
    assert_eq!(ComponentLock::holder(&dir, "sensor"), None);
}

#[test]
fn a_socket_at_the_limit_of_the_path_can_be_bound() {
    let (_root, dir) = rover();
    let endpoint = "g".repeat(106 - dir.folder().as_os_str().len());
    let bound = bind_ipc(&dir, &endpoint).unwrap();
    UnixStream::connect(bound.guard.path()).unwrap();
    assert!(matches!(bind_ipc(&dir, &(endpoint + "g")), Err(RuntimeDirError::PathTooLong { length: 108, .. })));
}

#[test]
fn a_tcp_address_is_private_and_removed_with_its_guard() {
    let (_root, dir) = rover();
    let bound = bind_tcp(&dir, ENDPOINT).unwrap();
    let file = dir.folder().join(format!("{ENDPOINT}.tcp"));
    assert_eq!(fs::read_to_string(&file).unwrap(), format!("{}\n", bound.address));
    assert_eq!(fs::metadata(&file).unwrap().mode() & 0o7777, 0o600);
    assert_eq!(find(&dir, ENDPOINT), Some(Address::Tcp(bound.address)));
    assert!(bound.address.ip().is_loopback());
    TcpStream::connect(bound.address).unwrap();
    drop(bound);
    assert!(names(&dir).is_empty());
}

#[test]
fn only_sockets_and_valid_addresses_are_found() {
    let (root, dir) = rover();
    let file = dir.folder().join("a.b.tcp");
    for text in ["", "garbage", "127.0.0.1", "127.0.0.1:0", "127.0.0.1:70000", "localhost:80", "127.0.0.1:80 x"] {
        fs::write(&file, text).unwrap();
        assert_eq!(find(&dir, "a.b"), None, "{text}");
    }
    fs::write(&file, b"\xff\xfe").unwrap();
    assert_eq!(find(&dir, "a.b"), None);
    fs::write(root.path().join("elsewhere"), "127.0.0.1:80").unwrap();
    fs::remove_file(&file).unwrap();
    symlink(root.path().join("elsewhere"), &file).unwrap();
    assert_eq!(find(&dir, "a.b"), None);
    fs::write(dir.folder().join("a.b"), "no socket").unwrap();
    assert_eq!(find(&dir, "a.b"), None);
    assert_eq!(find(&dir, "../elsewhere"), None);
}

#[test]
fn the_newer_of_two_addresses_is_found() {
    let (_root, dir) = rover();
    let ipc = bind_ipc(&dir, ENDPOINT).unwrap();
    let tcp = bind_tcp(&dir, ENDPOINT).unwrap();
    set_age(tcp.guard.path(), 1000);
    assert_eq!(find(&dir, ENDPOINT), Some(Address::Ipc(ipc.guard.path().into())));
    let file = fs::File::options().write(true).open(tcp.guard.path()).unwrap();
    file.set_modified(SystemTime::now() + Duration::from_secs(1000)).unwrap();
    assert_eq!(find(&dir, ENDPOINT), Some(Address::Tcp(tcp.address)));
}

fn announcement() -> Announcement {
    let endpoint = |contract: &str| {
        let mut endpoint = AnnouncedEndpoint::default();
        endpoint.gate = "measurements".into();
        endpoint.kind = "pub".into();
        endpoint.tap = contract == "bbbb";
        endpoint.endpoint = format!("sensor.measurements--controller.sensor.{contract}");
        endpoint.contract = contract.into();
        endpoint.payload = "rover.Measurement".into();
        endpoint.codec = "protobuf".into();
        endpoint.peers = vec!["controller.sensor".into()];
        endpoint
    };
    let mut announcement = Announcement::of_this_process("sensor");
    announcement.started = SystemTime::UNIX_EPOCH + Duration::from_millis(1_700_000_000_123);
    announcement.program = "/opt/\"odd\"\\name\n/läuft".into();
    announcement.schema = Some("0a1b2c".into());
    announcement.endpoints = vec![endpoint("aaaa"), endpoint("bbbb")];
    announcement
}

#[test]
fn an_announcement_is_private_and_removed_with_its_guard() {
    let (_root, dir) = rover();
    assert_eq!(Announcement::read(&dir, "sensor"), None);
    let guard = announcement().publish(&dir).unwrap();
    assert_eq!(names(&dir), ["sensor.json"]);
    assert_eq!(fs::metadata(guard.path()).unwrap().mode() & 0o7777, 0o600);
    assert_eq!(Announcement::read(&dir, "sensor"), Some(announcement()));
    let mut replacement = announcement();
    replacement.pid = 1;
    let replacement = replacement.publish(&dir).unwrap();
    drop(guard);
    assert_eq!(Announcement::read(&dir, "sensor").unwrap().pid, 1);
    drop(replacement);
    assert!(names(&dir).is_empty());
}

#[test]
fn a_damaged_announcement_is_ignored() {
    let (_root, dir) = rover();
    let path = dir.folder().join("sensor.json");
    drop(announcement().publish(&dir).map(|guard| fs::copy(guard.path(), dir.folder().join("copy")).unwrap()));
    let whole = fs::read(dir.folder().join("copy")).unwrap();
    for length in 0..whole.len() - 1 {
        fs::write(&path, &whole[..length]).unwrap();
        assert_eq!(Announcement::read(&dir, "sensor"), None, "{length} bytes");
    }
    let huge =
        format!("{{\"started_ms\":{},\"endpoints\":[],\"component\":\"a\",\"program\":\"\",\"pid\":1}}", u64::MAX);
    let deep = "[".repeat(100_000);
    for text in ["null", "[]", "{}", "{\"pid\":-1}", &deep, &huge.replace(":1}", ":99999999999}")] {
        fs::write(&path, text).unwrap();
        assert_eq!(Announcement::read(&dir, "sensor"), None, "{text}");
    }
    fs::write(&path, &whole).unwrap();
    assert_eq!(Announcement::read(&dir, "sensor"), Some(announcement()));
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    assert_eq!(Announcement::read(&dir, "sensor"), None);
    fs::remove_dir(&path).unwrap();
    // Opening a pipe must not wait for a writer.
    mknodat(CWD, &path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).unwrap();
    assert_eq!(Announcement::read(&dir, "sensor"), None);
}

#[test]
fn announcements_of_older_and_newer_formats_are_read() {
    let (_root, dir) = rover();
    let old = r#"{"component": "sensor", "pid": 7, "started_ms": 1, "program": "/bin/sensor", "endpoints": [
        {"gate": "log", "endpoint": "sensor.log.aaaa", "contract": "aaaa", "payload": "Log", "codec": "json"}]}"#;
    let new = old.replace(r#"{"component""#, r#"{"version": 1000, "new": [], "schema": null, "component""#);
    let new = new.replace(r#"{"gate""#, r#"{"kind": "new kind", "peers": ["a.b", 7], "new": {}, "gate""#);
    let read = |text: &str| {
        fs::write(dir.folder().join("sensor.json"), text).unwrap();
        let read = Announcement::read(&dir, "sensor").unwrap();
        assert_eq!((read.pid, read.schema, read.endpoints.len()), (7, None, 1));
        let endpoint = read.endpoints[0].clone();
        assert_eq!((&*endpoint.gate, &*endpoint.endpoint, endpoint.tap), ("log", "sensor.log.aaaa", false));
        (read.version, endpoint.kind, endpoint.peers)
    };
    assert_eq!(read(old), (0, String::new(), vec![]));
    assert_eq!(read(&new), (1000, "new kind".to_owned(), vec!["a.b".to_owned()]));
}

#[test]
fn leftovers_of_the_component_are_removed_and_nothing_else() {
    let (_root, dir) = rover();
    let lock = ComponentLock::take(&dir, "sensor").unwrap();
    drop(UnixListener::bind(dir.folder().join("sensor.measurements")).unwrap());
    drop(UnixListener::bind(dir.folder().join("sensor2.measurements")).unwrap());
    for name in ["sensor.calibration.1a2b.tcp", "sensor.json", "sensor.notes", "controller.json"] {
        fs::write(dir.folder().join(name), "").unwrap();
    }
    lock.clear_leftovers().unwrap();
    assert_eq!(names(&dir), ["controller.json", "sensor.lock", "sensor.notes", "sensor2.measurements"]);
}
