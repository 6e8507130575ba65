//! Several threads of a C program.

use crate::programs::{expect_success, on_each_build};

/// The promise: a gate that another thread uses is busy, others work, and closing ends every call that waits.
#[test]
fn gates_are_used_and_closed_by_several_threads() {
    on_each_build(|program| {
        let _peer = program.peer();
        let mut c = program.start("threads", &[]);
        for step in ["one gate", "closed", "done"] {
            c.expect(step);
        }
        expect_success(c);
    });
}
