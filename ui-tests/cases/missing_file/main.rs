//! The path is misspelt.

scl::topology!("topolgy.yaml");

fn main() {}
