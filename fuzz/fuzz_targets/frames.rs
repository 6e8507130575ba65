//! Any bytes, said to a real end of the `zeromq` transport, leave it as it was for good peers.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_tests::fuzz::frames(data));
