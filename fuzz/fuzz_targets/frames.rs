//! An unknown peer sends any bytes to a real end of the `zeromq` transport, which must serve well-behaved peers
//! afterwards.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_tests::fuzz::frames(data));
