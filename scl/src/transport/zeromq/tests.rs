//! Tests of roles over real sockets.

mod burst;
mod credit;
mod deferred;
mod ends;
mod hostile;
mod plain;
mod roles;
#[cfg(feature = "iceoryx2")]
mod shared;
#[cfg(feature = "iceoryx2")]
mod shared_hostile;
mod stage;
mod subject;
mod witness;
