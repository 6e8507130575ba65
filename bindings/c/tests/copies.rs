//! Several copies of the library in one process, as plugins with a static library of their own bring them along.

use crate::programs::{Build, Program, expect_success};
use scl_tests::{System, c_library};

/// The promise: a component runs once, whichever copy has opened it, and looking for it from another copy does not give
/// its lock away.
#[test]
fn two_copies_in_one_process_respect_each_others_locks() {
    let program = Program::new(System::new(), Build::Plain);
    let folder = tempfile::tempdir().unwrap();
    let copies = ["one.so", "other.so"].map(|name| folder.path().join(name));
    for copy in &copies {
        std::fs::copy(c_library().folder.join("libscl.so"), copy).unwrap();
    }
    let mut c = program.start("copies", &copies.each_ref().map(|copy| copy.to_str().unwrap()));
    c.expect("open");
    for _ in 0..2 {
        let refused = program.start("commands", &["program", ""]).wait_for_exit();
        assert!(refused.text().contains("SCL_TAKEN"), "{refused:?}");
    }
    c.tell("go on");
    c.expect("closed");
    expect_success(c);
}
