//! A C program that reads the parameters of its component.

use crate::programs::{expect_success, on_each_build};

/// The promise: every type has its call, and a wrong name, type, index or value is explained.
#[test]
fn a_program_reads_its_parameters() {
    on_each_build(|program| {
        let environment = [("SCL_SET", "program.gain=1.5,program.pin=7,peer.other=1")];
        let mut c = program.start_with("parameters", &[], &environment);
        c.expect("done");
        expect_success(c);
    });
}
