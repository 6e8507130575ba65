//! The items that generated code uses. They carry no promise of stability.

#[cfg(feature = "protobuf")]
pub mod floats;
mod message_json;

pub use crate::__choice as choice;
pub use crate::__component_main_functions as component_main_functions;
pub use crate::__component_methods as component_methods;
pub use crate::__component_test_methods as component_test_methods;
pub use crate::__instances as instances;
pub use crate::__kind_methods as kind_methods;
#[cfg(all(feature = "json", feature = "protobuf"))]
pub use crate::__message_json as message_json;
#[cfg(not(all(feature = "json", feature = "protobuf")))]
pub use crate::__no_message_json as message_json;
pub use crate::__senders as senders;
#[cfg(all(feature = "json", feature = "protobuf"))]
pub use crate::codec::message_json::{MessagePool, MessageType};
pub use crate::codec::{self, Codec, by_name as codecs};
pub use crate::component::{
    Component, ComponentHandle, Opener, Returned, block_on, close, close_blocking, instance, open, open_as,
    open_blocking, open_blocking_as, ready, run_async, run_blocking,
};
pub use crate::error::OpenError;
pub use crate::gate::{AnyGate, Pub, Pull, Push, Rep, Req, Sub};
pub use crate::named_type::NamedType;
pub use crate::parameters::{FromParameter, Live};
pub use crate::senders::Senders;
pub use crate::spec::{
    ComponentSpec, ConnectionSpec, GateKind, GateOptions, GateSpec, KindSpec, ParameterPlan, Schema, Undecodable,
    WhenFull,
};
#[cfg(feature = "memory")]
pub use crate::transport::memory::Memory;
pub use bytes::Bytes;
#[cfg(feature = "protobuf")]
pub use prost;
#[cfg(feature = "protobuf")]
pub use prost_types;
pub use scl_macros::__topology;
pub use scl_plan::{ParameterType, Scalar};
#[cfg(feature = "json")]
pub use serde;
pub use std::borrow::Cow;
pub use std::marker::PhantomPinned;
pub use std::time::Duration;
