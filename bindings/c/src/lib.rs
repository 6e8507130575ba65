//! The C library. `include/scl.h` is generated from the public functions of this crate, so their documentation is for C
//! programmers.
//!
//! Every function of the interface is a thin wrapper: it checks its pointers (`border`), finds the handle (`registry`)
//! and calls the crate `scl`. Panics are caught at the border.
#![cfg_attr(test, allow(clippy::unwrap_used))]

// The header lists the functions in the order of these modules.
mod version;

mod status;

mod error;

mod component;

mod parameter;

mod gate;

mod send;

mod receive;

mod marked;
mod message;

mod call;

mod request;

mod wait;

mod stats;

mod generated;
mod stop;

// Internal modules, which export no functions.
mod border;
mod fork;
mod options;
mod patience;
mod registry;
mod texts;
mod thread;
mod values;
