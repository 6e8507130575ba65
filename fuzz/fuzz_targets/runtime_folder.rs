//! Whatever the runtime folder contains, a component opens there or reports what prevents it.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_tests::fuzz::runtime_folder(data));
