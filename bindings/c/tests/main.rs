//! The C library as C programs use it: its header, and programs of the folder `tests` as peers of this test.
#![allow(clippy::unwrap_used)]

mod header;
