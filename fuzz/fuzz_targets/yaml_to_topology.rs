//! Any text is parsed, checked and rendered without a panic.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| scl_fuzz::yaml_to_topology(text));
