//! Passes anything that an unknown peer may send to the decoder of the protocol.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_tests::fuzz::decoder(data));
