//! What generated code names. It carries no promise of stability.

pub use crate::__component_methods as component_methods;
pub use crate::__component_test_methods as component_test_methods;
pub use crate::codec::{self, Codec};
pub use crate::component::{
    Component, ComponentHandle, Opener, Outcome, block_on, close, close_blocking, open, open_blocking, ready,
    run_async, run_blocking,
};
pub use crate::error::OpenError;
pub use crate::gate::{AnyGate, Pub, Pull, Push, Rep, Req, Sub};
pub use crate::spec::{ComponentSpec, GateKind, GateOptions, GateSpec, LinkSpec, Schema, WhenFull};
#[cfg(feature = "memory")]
pub use crate::transport::memory::Memory;
pub use bytes::Bytes;
#[cfg(feature = "protobuf")]
pub use prost;
#[cfg(feature = "protobuf")]
pub use prost_types;
pub use scl_macros::__topology;
pub use std::time::Duration;
