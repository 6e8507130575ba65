//! What a program meets at run time that should not be: each mistake is said, and what is sound goes on.

use scl_tests::{Place, Process, python_with_pyzmq};
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;

const PEER: &str = env!("CARGO_BIN_EXE_peer");

#[test]
fn a_second_program_for_a_component_is_told_who_plays_it() {
    let place = Place::new("ipc");
    let mut first = place.start(PEER, &["sink"]);
    first.says("open");
    let (status, said) = place.start(PEER, &["sink"]).ends();
    assert!(!status.success());
    let said = said.join("\n");
    assert!(said.contains("component `sink` cannot be opened"), "{said}");
    assert!(said.contains(&first.id().to_string()), "{said}");
}

#[test]
fn a_runtime_folder_that_others_may_write_to_is_refused() {
    let place = Place::new("ipc");
    std::fs::set_permissions(place.runtime_dir(), PermissionsExt::from_mode(0o777)).expect("opened to all");
    let (status, said) = place.start(PEER, &["sink"]).ends();
    assert!(!status.success());
    let said = said.join("\n");
    assert!(said.contains(&*place.runtime_dir().to_string_lossy()), "{said}");
}

#[test]
fn a_runtime_folder_too_deep_for_a_socket_is_refused() {
    let place = Place::new("ipc");
    let deep = place.runtime_dir().join("d".repeat(90));
    let environment = [("SCL_RUNTIME_DIR", deep.as_os_str())];
    let (status, said) = Process::start(PEER, &["sink"], &environment).ends();
    assert!(!status.success());
    let said = said.join("\n");
    assert!(said.contains("107"), "{said}");
}

#[test]
fn a_transport_that_does_not_exist_is_refused() {
    let place = Place::new("udp");
    let (status, said) = place.start(PEER, &["sink"]).ends();
    assert!(!status.success());
    assert_eq!(said, ["failed: `SCL_TRANSPORT=udp` is not understood; write one of: `ipc`, `tcp`"]);
}

#[test]
fn a_message_that_does_not_decode_names_gate_peer_and_codec_and_the_next_is_received() {
    let place = Place::new("ipc");
    // The sink shows the plain publisher where it would look for the source.
    let mut sink = place.start(PEER, &["sink"]);
    sink.says("open");
    let mut source = place.start(PEER, &["source"]);
    source.says("open");
    let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("python/garbage.py");
    let folder = place.runtime_dir().join("six");
    let arguments = [script.to_str().expect("a path in UTF-8"), folder.to_str().expect("a path in UTF-8")];
    source.does("ready 30000", "ready");
    sink.tell("serve 2");
    let mut plain = Process::start(python_with_pyzmq(), &arguments, &[]);
    let said = sink.line();
    assert!(
        said.starts_with("error: gate `sink.answer` received something from `source.question` that is no message: "),
        "{said}"
    );
    assert!(said.contains("protobuf"), "{said}");
    sink.says("served");
    plain.says(r"b'\x08\n'");
    assert!(plain.ends().0.success());
}
