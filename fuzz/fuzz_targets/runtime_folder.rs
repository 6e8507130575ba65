//! Whatever lies in the runtime folder, a component opens there or says what is in its way.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_tests::fuzz::runtime_folder(data));
