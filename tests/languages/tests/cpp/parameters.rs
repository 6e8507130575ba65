//! A C++ program that reads the parameters of its components, as `bindings/cpp/tests/programs/parameters.cpp` does.

use super::build::{Build, binding, program};
use scl_tests::System;

/// The promise: every type becomes its C++ type, values can be set, and wrong ones are explained.
#[test]
fn a_program_reads_its_parameters() {
    let topology = binding().join("../../crates/scl-generate/tests/topologies/controls.yaml");
    for build in [Build::Plain, Build::Address] {
        let program = program(&binding().join("tests/programs/parameters.cpp"), &topology, build);
        let system = System::new();
        let set = [("SCL_SET", "controller.gain=1.5,left_motor.pin=3")];
        let exit = system.start_with(program.to_str().expect("a path of ASCII"), &[], &set).wait_for_exit();
        assert_eq!((exit.code(), exit.text().as_str()), (0, "done"), "{build:?}");
    }
}
