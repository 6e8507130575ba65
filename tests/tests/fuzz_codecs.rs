//! Damaged and senseless frames, read by every codec. What the fuzz target finds becomes a case here.

use scl_tests::fuzz::{Generator, codecs, frames_of_every_codec};
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// What was found: a number that changed on its way; memory taken for elements that were only announced.
const FOUND: [&[u8]; 4] = [
    b"\x0b22222222222222222222222222222222222222222222222222222222222222222222222222222222222222222",
    b"\x08\xa1\x64Many\x9a\xff\xff\xff\xff",
    b"\x09\x81\xa4Many\xdd\xff\xff\xff\xff",
    b"\x0a\x04\xff\xff\xff\xff\x0f",
];

/// One test, because what another one allocates meanwhile would be counted too.
#[test]
fn no_frame_harms_a_codec() {
    for found in FOUND {
        codecs(found);
        // What is announced on every level adds up.
        codecs(&[&found[..1], &found[1..].repeat(100)].concat());
    }
    let mut generator = Generator::new(1);
    for sound in frames_of_every_codec() {
        codecs(&sound);
        for length in 0..sound.len() {
            codecs(&sound[..length]);
        }
        for _ in 0..2_000 {
            let choice = &sound[..1];
            codecs(&[choice, &generator.damaged(&sound[1..])].concat());
            codecs(&[choice, &generator.noise(60)].concat());
            // What nests is short and comes again and again.
            let piece = generator.noise(8);
            codecs(&[choice, &piece.repeat(generator.below(300))].concat());
        }
    }
}
