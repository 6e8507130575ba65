//! What the compiler says when the wiring is wrong: one folder a mistake below `cases/`, with the program, its topology
//! and the expected text. The rules themselves are tested below rustc, in `scl-topology`.

pub mod awkward;
