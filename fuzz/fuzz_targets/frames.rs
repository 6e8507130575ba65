//! A stranger sends any bytes to a real end of the `zeromq` transport, which serves good peers afterwards.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_tests::fuzz::frames(data));
