//! Tests of both ends together.

use crate::{Limits, LoanError, ReceiveError, SampleReceiver, SampleSender, ServiceName, SharedMemory};
use tempfile::TempDir;

struct Pair {
    sender: SampleSender,
    receiver: SampleReceiver,
    folder: TempDir,
}

fn pair(queue: usize) -> Pair {
    let folder = TempDir::with_prefix("scl-shm").unwrap();
    let memory = SharedMemory::open(folder.path()).unwrap();
    let name = ServiceName::unique();
    let receiver = memory.receiver(name, Limits { queue, longest: 1 << 20 }).unwrap();
    let sender = memory.sender(name, 1000).unwrap();
    Pair { sender, receiver, folder }
}

fn content(length: usize) -> Vec<u8> {
    (0..length).map(|index| (index % 251) as u8).collect()
}

#[test]
fn samples_of_any_length_arrive() {
    let Pair { folder: _folder, mut sender, mut receiver } = pair(4);
    for length in [1, 1000, 20_000, 4 << 20, 5000, (4 << 20) + 1, 100_000] {
        let sample = sender.copy(&content(length)).unwrap();
        sender.send(sample).unwrap();
        assert_eq!(receiver.receive(length as u64).unwrap(), content(length), "{length}");
        let mut loan = sender.loan(length).unwrap();
        assert_eq!(loan.as_slice().as_ptr().addr() % 64, 0);
        loan.as_mut_slice().fill(7);
        sender.send(loan).unwrap();
        assert_eq!(receiver.receive(length as u64).unwrap(), vec![7; length], "{length}");
    }
}

#[test]
fn what_is_kept_beyond_the_limit_is_copied_and_counted() {
    let Pair { folder: _folder, mut sender, mut receiver } = pair(2);
    let mut kept = Vec::new();
    for index in 0..15_usize {
        let sample = sender.copy(&content(20_000 + index)).unwrap();
        sender.send(sample).unwrap();
        kept.push(receiver.receive(20_000 + index as u64).unwrap());
    }
    assert_eq!(receiver.copied(), 5, "the queue's two and eight views stay where they are");
    for (index, received) in kept.iter().enumerate() {
        assert_eq!(*received, content(20_000 + index));
    }
    kept.clear();
    let sample = sender.copy(b"again").unwrap();
    sender.send(sample).unwrap();
    assert_eq!(receiver.receive(5).unwrap(), "again");
    assert_eq!(receiver.copied(), 5);
}

#[test]
fn samples_outlive_both_ends() {
    let Pair { folder, mut sender, mut receiver } = pair(2);
    let sample = sender.copy(&content(100_000)).unwrap();
    sender.send(sample).unwrap();
    let received = receiver.receive(100_000).unwrap();
    let loan = sender.loan(10).unwrap();
    drop((sender, receiver));
    assert_eq!(received, content(100_000));
    assert_eq!(loan.as_slice().len(), 10);
    let prefix = prefix_of(folder.path());
    assert!(!files(&prefix).is_empty());
    drop((received, loan));
    assert_eq!(files(&prefix), [""; 0]);
}

#[test]
fn loans_are_limited_and_given_back() {
    let Pair { folder: _folder, mut sender, mut receiver } = pair(1);
    let loans = [sender.loan(30_000).unwrap(), sender.loan(30_000).unwrap()];
    assert_eq!(sender.loan(30_000).unwrap_err(), LoanError::TooMany);
    // One is left for copies.
    let sample = sender.copy(b"message").unwrap();
    assert!(sender.has_lent(&sample));
    sender.send(sample).unwrap();
    assert_eq!(receiver.receive(7).unwrap(), "message");
    drop(loans);
    sender.loan(30_000).unwrap();
}

#[test]
fn a_loan_of_another_connection_is_recognised() {
    let (mut first, second) = (pair(1), pair(1));
    let loan = first.sender.loan(1).unwrap();
    assert!(first.sender.has_lent(&loan) && !second.sender.has_lent(&loan));
}

#[test]
fn what_does_not_fit_the_announcement_is_refused() {
    let Pair { folder: _folder, mut sender, mut receiver } = pair(4);
    assert_eq!(receiver.receive(1).unwrap_err(), ReceiveError::Missing);
    let sample = sender.copy(b"message").unwrap();
    sender.send(sample).unwrap();
    assert_eq!(receiver.receive(8).unwrap_err(), ReceiveError::Length { announced: 8, sent: 7 });
}

#[test]
fn a_sample_beyond_the_window_is_an_error() {
    let Pair { folder: _folder, mut sender, receiver } = pair(2);
    for _ in 0..sender.in_flight() {
        let sample = sender.copy(b"message").unwrap();
        sender.send(sample).unwrap();
    }
    let sample = sender.copy(b"message").unwrap();
    sender.send(sample).unwrap_err();
    drop(receiver);
    let sample = sender.copy(b"message").unwrap();
    sender.send(sample).unwrap_err();
}

#[test]
fn services_are_found_by_their_name_only_and_once() {
    let Pair { folder, .. } = pair(1);
    let memory = SharedMemory::open(folder.path()).unwrap();
    let name = ServiceName::unique();
    assert!(memory.sender(name, 1).unwrap_err().to_string().contains("open the connection's service"));
    let limits = Limits { queue: 1, longest: 1 };
    let _receiver = memory.receiver(name, limits).unwrap();
    assert!(memory.receiver(name, limits).unwrap_err().to_string().contains("create the connection's service"));
    let _sender = memory.sender(name, 1).unwrap();
    assert!(memory.sender(name, 1).is_err(), "there is room for one");
}

#[test]
fn services_with_other_settings_are_refused() {
    let folder = TempDir::with_prefix("scl-shm").unwrap();
    let memory = SharedMemory::open(folder.path()).unwrap();
    let foreign = |name: ServiceName, overflow, publishers| {
        memory.foreign_service(name, |service| service.enable_safe_overflow(overflow).max_publishers(publishers))
    };
    for (overflow, publishers, expected) in [
        (true, 1, "the peer's service has an overflow or a history"),
        (false, 2, "the peer's service has room for more than one connection"),
        (false, 1, "the peer's service has room for more than one connection"),
    ] {
        let name = ServiceName::unique();
        let _service = foreign(name, overflow, publishers);
        assert_eq!(memory.sender(name, 1).unwrap_err().to_string(), expected);
    }
}

#[test]
fn more_than_there_is_is_not_lent() {
    let Pair { folder: _folder, mut sender, mut receiver } = pair(2);
    let LoanError::TooLittle(error) = sender.loan(1 << 50).unwrap_err() else { panic!("another error") };
    assert!(error.needed > 1 << 50 && error.available < 1 << 50, "{error}");
    let sample = sender.copy(b"still there").unwrap();
    sender.send(sample).unwrap();
    assert_eq!(receiver.receive(11).unwrap(), "still there");
}

#[test]
fn no_file_is_open_to_other_users() {
    use std::os::unix::fs::PermissionsExt;
    let Pair { folder, sender: _sender, receiver: _receiver } = pair(1);
    for name in files(&prefix_of(folder.path())) {
        let mode = std::fs::metadata(format!("/dev/shm/{name}")).unwrap().permissions().mode();
        assert_eq!(mode & 0o077, 0, "{name}: {mode:o}");
    }
}

#[test]
fn nothing_stays() {
    let Pair { folder, mut sender, mut receiver } = pair(3);
    let prefix = prefix_of(folder.path());
    assert!(!files(&prefix).is_empty(), "the test looks for the wrong names");
    for length in [10, 100_000, 3_000_000] {
        let sample = sender.copy(&content(length)).unwrap();
        sender.send(sample).unwrap();
        receiver.receive(length as u64).unwrap();
    }
    drop(sender);
    assert!(!files(&prefix).is_empty());
    drop(receiver);
    assert_eq!(files(&prefix), [""; 0]);
}

#[test]
fn nothing_stays_if_the_folder_is_removed_first() {
    let Pair { folder, sender, receiver } = pair(3);
    let prefix = prefix_of(folder.path());
    drop(folder);
    assert!(!files(&prefix).is_empty());
    drop((sender, receiver));
    assert_eq!(files(&prefix), [""; 0]);
}

#[test]
fn what_a_killed_program_left_is_removed() {
    let folder = TempDir::with_prefix("scl-shm").unwrap();
    let prefix = prefix_of(folder.path());
    let stale = format!("/dev/shm/{prefix}12345__0.data");
    std::fs::write(&stale, "stale").unwrap();
    let memory = SharedMemory::open(folder.path()).unwrap();
    assert!(!std::path::Path::new(&stale).exists());
    assert!(!files(&prefix).is_empty(), "the files in use were removed, too");
    drop(memory);
    assert_eq!(files(&prefix), [""; 0]);
}

fn prefix_of(folder: &std::path::Path) -> String {
    crate::folder::Folder::create(folder).unwrap().prefix().to_owned()
}

fn files(prefix: &str) -> Vec<String> {
    let names = std::fs::read_dir("/dev/shm").unwrap().map(|entry| entry.unwrap().file_name());
    names.filter_map(|name| name.into_string().ok()).filter(|name| name.starts_with(prefix)).collect()
}

/// A program that is killed while it creates or removes its node leaves one whose state the engine cannot tell.
#[test]
fn a_node_without_a_state_is_removed() {
    let folder = TempDir::with_prefix("scl-shm").unwrap();
    let prefix = prefix_of(folder.path());
    let memory = SharedMemory::open(folder.path()).unwrap();
    let nodes = folder.path().join("shm/nodes");
    let names = std::fs::read_dir(&nodes).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let node = names.filter_map(|name| name.strip_prefix(&prefix)?.strip_suffix(".node_monitor")?.parse::<u128>().ok());
    let other = node.max().unwrap() - 1;
    for suffix in ["node_monitor", "node_monitor_context"] {
        std::fs::write(nodes.join(format!("{prefix}{other}.{suffix}")), "").unwrap();
    }
    drop(memory);
    assert_eq!(files(&prefix), [""; 0]);
}
