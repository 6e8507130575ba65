//! Shared memory between processes: no copies, nothing left behind, and everybody else served as before.

mod copies;
mod exit;
mod foreign;
mod kill;
mod mixed;
mod second_user;
mod stage;
mod too_little;
mod views;
