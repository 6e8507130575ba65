//! Any text is a plan or an error.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| scl_fuzz::plan_text(text));
