//! Tests of roles over real sockets.

mod burst;
mod credit;
mod crowd;
mod deferred;
mod dialling;
mod ends;
mod hostile;
mod plain;
mod roles;
#[cfg(feature = "shm")]
mod shared;
#[cfg(feature = "shm")]
mod shared_hostile;
mod stage;
mod subject;
mod times;
mod witness;
