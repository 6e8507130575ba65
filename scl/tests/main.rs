//! The integration tests of the crate, in one binary.

#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod age;
#[cfg(all(feature = "json", feature = "memory"))]
mod auto_traits;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod bridge;
#[cfg(feature = "conformance")]
mod conformance_codecs;
#[cfg(all(feature = "conformance", feature = "memory"))]
mod conformance_memory;
#[cfg(all(feature = "conformance", feature = "zeromq"))]
mod conformance_zeromq;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod due;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod full_queue;
#[cfg(all(feature = "conformance", feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod guarantees;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod held_memory;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod kinds;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod latched;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod late_peers;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod live;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "raw", feature = "zeromq"))]
mod loans;
#[cfg(all(feature = "json", feature = "memory"))]
mod memory_components;
#[cfg(all(feature = "json", feature = "memory"))]
mod memory_queues;
#[cfg(all(feature = "memory", feature = "zeromq"))]
mod model;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod negative_zero;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod parameters;
mod registry;
mod runtime_dir_files;
mod runtime_dir_folder;
mod runtime_dir_processes;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod several_files;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod slow_senders;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod stats;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod tap;
#[cfg(all(feature = "json", feature = "memory", feature = "protobuf", feature = "zeromq"))]
mod untyped;
