//! The paper's Listing 1, byte for byte: four untyped programs, over Unix sockets and TCP, and a plain ZeroMQ program
//! in the place of one of them.

use scl_tests::{Place, Process, python_with_pyzmq};
use std::path::PathBuf;

const PROGRAM: &str = env!("CARGO_BIN_EXE_listing1");

#[test]
fn four_programs_talk() {
    for transport in ["ipc", "tcp"] {
        let place = Place::new(transport);
        let mut actuator = place.start(PROGRAM, &["actuator"]);
        let mut user_interface = place.start(PROGRAM, &["user_interface"]);
        let _controller = place.start(PROGRAM, &["controller"]);
        let mut sensor = place.start(PROGRAM, &["sensor"]);
        sensor.says("sent");
        actuator.says("set to b\"measured\"");
        user_interface.says("status b\"done\", event b\"faster\"");
        assert!(user_interface.ends().0.success());
    }
}

#[test]
fn a_plain_zeromq_program_plays_the_user_interface() {
    let place = Place::new("ipc");
    let _controller = place.start(PROGRAM, &["controller"]);
    let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("python/user_interface.py");
    let folder = place.runtime_dir().join("listing1");
    let arguments = [script.to_str().expect("a path in UTF-8"), folder.to_str().expect("a path in UTF-8")];
    let mut plain = Process::start(python_with_pyzmq(), &arguments, &[]);
    plain.says("b'done'");
    plain.says("b'faster'");
    assert!(plain.ends().0.success());
}
