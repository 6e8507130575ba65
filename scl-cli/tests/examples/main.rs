//! The systems of the paper: the aircraft flies, the radio tunes, and both survive the death of their parts.
#![allow(clippy::unwrap_used)]

mod arcade;
mod ospecorr;
