//! The transport within one process keeps every guarantee.

scl::transport_conformance!((scl::transport::memory::Memory::new(), ()));
