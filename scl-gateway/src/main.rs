//! The command `scl-gateway`.

fn main() {}
