//! Generated code in unfriendly surroundings, in one binary.

mod renamed;
mod shadowed;
