//! `scl record` and `scl recover` on real systems, and what is in the files.

mod crash;
mod disk;
mod hostile;
mod latched;
mod messages;
mod missed;
mod mistakes;
mod moved;
mod parameters;
mod recorder;
mod ring;
mod source;
mod split;
mod starts;
mod truncated;
