//! Strangers that say anything to an end. What the fuzz target finds becomes a case here.

use scl_tests::fuzz::{Generator, frames};
use std::panic;
use std::sync::atomic::{AtomicUsize, Ordering};

static PANICS: AtomicUsize = AtomicUsize::new(0);

#[test]
fn no_stranger_harms_an_end() {
    let report = panic::take_hook();
    // Those in tasks are told to nobody else.
    panic::set_hook(Box::new(move |info| {
        PANICS.fetch_add(1, Ordering::SeqCst);
        report(info);
    }));
    let mut generator = Generator::new(2);
    for round in 0..240 {
        let mut input = generator.noise(300);
        // Each role has its turn.
        input.insert(0, round);
        frames(&input);
        assert_eq!(PANICS.load(Ordering::SeqCst), 0, "{input:?}");
    }
}
