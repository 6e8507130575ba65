//! Any model, also one that no text gives, is checked without a panic.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_fuzz::model_to_topology(data));
