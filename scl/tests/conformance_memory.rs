//! The memory transport keeps every guarantee.

scl::transport_conformance!((scl::transport::memory::Memory::new(), ()));
