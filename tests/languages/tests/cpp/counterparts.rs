//! A C++ program with unit tests of a component, as `bindings/cpp/tests/programs/counterparts.cpp` has them.

use super::build::{Build, binding, program};
use scl_tests::System;

/// The promise: a component and its counterpart work within one process, without files, warnings or leaks.
#[test]
fn a_component_is_opened_beside_its_counterpart() {
    let topology = binding().join("../../crates/scl-generate/tests/topologies/testable.yaml");
    for build in [Build::Plain, Build::Address] {
        let program = program(&binding().join("tests/programs/counterparts.cpp"), &topology, build);
        let system = System::new();
        let exit = system.start(program.to_str().expect("a path of ASCII"), &[]).wait_for_exit();
        assert_eq!((exit.code(), exit.text().as_str()), (0, "done"), "{build:?}");
        assert_eq!(std::fs::read_dir(system.runtime_dir()).expect("the folder").count(), 0);
    }
}
