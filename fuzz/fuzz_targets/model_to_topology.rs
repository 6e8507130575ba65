//! Any model is checked without a panic, even one that no text describes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scl_fuzz::model_to_topology(data));
