//! Tests of roles over real sockets.

mod burst;
mod credit;
mod deferred;
mod ends;
mod hostile;
mod plain;
mod roles;
mod stage;
mod subject;
mod witness;
