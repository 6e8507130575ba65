//! Runs one fuzz target over generated input, the same in every run: `fuzz_round codecs`, `frames`, `decoder`
//! or `runtime_folder`.
//!
//! A process of its own, because the codecs' allocations are counted and panics in any task must be noticed.

use scl_tests::fuzz::{Generator, codecs, decoder, frames, frames_of_every_codec, runtime_folder};
use scl_tests::say;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::panic;
use std::sync::atomic::{AtomicUsize, Ordering};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

static PANICS: AtomicUsize = AtomicUsize::new(0);

/// Found by fuzzing: a number that changed on its way; memory reserved for elements that were only announced.
const FOUND: [&[u8]; 4] = [
    b"\x0b22222222222222222222222222222222222222222222222222222222222222222222222222222222222222222",
    b"\x08\xa1\x64Many\x9a\xff\xff\xff\xff",
    b"\x09\x81\xa4Many\xdd\xff\xff\xff\xff",
    b"\x0a\x04\xff\xff\xff\xff\x0f",
];

fn main() {
    match std::env::args().nth(1).unwrap_or_default().as_str() {
        "codecs" => run_codecs(),
        "frames" => run_frames(),
        "decoder" => run_decoder(),
        _ => run_runtime_folder(),
    }
    say("done");
}

fn run_codecs() {
    for found in FOUND {
        codecs(found);
        // What is announced on every level adds up.
        codecs(&[&found[..1], &found[1..].repeat(100)].concat());
    }
    let mut generator = Generator::new(1);
    for valid in frames_of_every_codec() {
        codecs(&valid);
        for length in 0..valid.len() {
            codecs(&valid[..length]);
        }
        for _ in 0..2_000 {
            let choice = &valid[..1];
            codecs(&[choice, &generator.damaged(&valid[1..])].concat());
            codecs(&[choice, &generator.noise(60)].concat());
            // Nested values consist of a short piece that is repeated.
            let piece = generator.noise(8);
            codecs(&[choice, &piece.repeat(generator.below(300))].concat());
        }
    }
}

fn run_frames() {
    let report = panic::take_hook();
    // A panic in a task is reported nowhere else.
    panic::set_hook(Box::new(move |info| {
        PANICS.fetch_add(1, Ordering::SeqCst);
        report(info);
    }));
    let mut generator = Generator::new(2);
    for round in 0..240 {
        let mut input = generator.noise(300);
        // The first byte chooses the role.
        input.insert(0, round);
        frames(&input);
        assert_eq!(PANICS.load(Ordering::SeqCst), 0, "{input:?}");
    }
}

fn run_decoder() {
    let mut generator = Generator::new(4);
    for _ in 0..20_000 {
        decoder(&generator.noise(300));
    }
}

fn run_runtime_folder() {
    let mut generator = Generator::new(3);
    for _ in 0..100 {
        let mut input = generator.noise(200);
        // In most of them the folders themselves are sound.
        input.splice(0..0, [9, 9]);
        runtime_folder(&input);
        runtime_folder(&generator.noise(100));
    }
}
