//! A C program that tests a component of its own.

use crate::programs::{expect_success, on_each_build};

/// The promise: both ends of every kind of gate work within one process, without files, and wrong calls are explained.
#[test]
fn a_component_is_opened_beside_its_counterpart() {
    on_each_build(|program| {
        let mut c = program.start("counterpart", &[]);
        c.expect("done");
        expect_success(c);
        assert_eq!(std::fs::read_dir(program.system.runtime_dir()).unwrap().count(), 0);
    });
}
